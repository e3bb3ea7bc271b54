# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""YAML as people mean it: no key twice, and nothing that grows without end."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

from vehicle_pf_tracker.core.errors import InputError

_LARGEST_FILE = 2**20
"""Bytes; the parameter file of a variant has 6 kB, comments included."""


class _Loader(yaml.SafeLoader):
    """Refuses what ROS's own reader refuses (aliases), and keys that hide others."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()  # type: ignore[no-untyped-call]
            raise yaml.MarkedYAMLError(
                problem="aliases are not supported, nor by ROS itself",
                problem_mark=event.start_mark,
            )
        return super().compose_node(parent, index)

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        node: yaml.MappingNode = super().compose_mapping_node(anchor)
        seen: set[str] = set()
        for key, _ in node.value:
            name = str(key.value)
            if name in seen:
                raise yaml.MarkedYAMLError(
                    problem=f"the key {name[:80]!r} is there twice", problem_mark=key.start_mark
                )
            seen.add(name)
        return node


def check_yaml_file(path: Path, what: str) -> None:
    """Check a file that somebody else reads; arguments and errors are as in `read_yaml_file`."""
    _load(path, what, lambda loader: loader.get_single_node())


def read_yaml_file(path: Path, what: str) -> Any:
    """Read the one document of a YAML file.

    Parameters
    ----------
    path : Path
        The file.
    what : str
        What errors call it.

    Raises
    ------
    InputError
        If it cannot be read, is not YAML, has a key twice, or has aliases.
    """
    return _load(path, what, lambda loader: loader.get_single_data())


def _load(path: Path, what: str, get: Callable[[_Loader], Any]) -> Any:
    if path.exists() and not path.is_file():
        raise InputError(f"the {what} {path} is not a regular file")
    if path.exists() and path.stat().st_size > _LARGEST_FILE:
        raise InputError(f"the {what} {path} is larger than {_LARGEST_FILE // 2**20} MB")
    try:
        return get(_Loader(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise InputError(f"cannot read the {what} {path}: {error.strerror}") from None
    except RecursionError:
        raise InputError(f"the {what} {path} is not valid YAML: it is nested too deeply") from None
    # ValueError: bytes that are not text, numbers of thousands of digits, dates that are none.
    except (yaml.YAMLError, ValueError) as error:
        reason = " ".join(str(error).split())[:300]
        raise InputError(f"the {what} {path} is not valid YAML: {reason}") from None
