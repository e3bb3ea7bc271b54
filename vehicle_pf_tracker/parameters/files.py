# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters to and from ROS parameter files: YAML without repeated keys or aliases."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.parameters.table import EFFECTS, ParameterSpec, Value

_LARGEST_FILE = 2**20
"""Largest file that is read, bytes: a megabyte, where those of the variants have at most 11 kB."""


_WIDTH = 96
"""Width of comments: with their indent of four and "# ", lines of at most about 100 characters."""


class _Loader(yaml.SafeLoader):
    """Loader that refuses aliases, as ROS's own reader does, and keys that hide others."""

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


def read_yaml_file(path: Path, what: str) -> Any:
    """Read the one document of a YAML file.

    Parameters
    ----------
    path : Path
        The file.
    what : str
        Name of the file in errors.

    Raises
    ------
    InputError
        If it cannot be read, is not YAML, has a key twice, or has aliases.
    """
    if path.is_file() and path.stat().st_size > _LARGEST_FILE:
        raise InputError(f"the {what} {path} is larger than {_LARGEST_FILE // 2**20} MB")
    text = read_text(path, f"the {what}")
    try:
        return yaml.load(text, _Loader)  # noqa: S506 - a safe loader
    except RecursionError:
        raise InputError(f"the {what} {path} is not valid YAML: it is nested too deeply") from None
    # ValueError: characters that YAML forbids, numbers of thousands of digits, dates that are none.
    except (yaml.YAMLError, ValueError) as error:
        reason = " ".join(str(error).split())[:300]
        raise InputError(f"the {what} {path} is not valid YAML: {reason}") from None


def to_yaml(table: Mapping[str, ParameterSpec], values: Mapping[str, Value], title: str) -> str:
    """Write `values` as a commented ROS parameter file for any node name and namespace."""
    lines = [f"# {title}", "/**:", "  ros__parameters:"]
    for name, spec in table.items():
        lines += [f"    # {line}" for line in textwrap.wrap(_comment(spec), _WIDTH)]
        lines.append(f"    {name}: {_scalar(values[name])}")
    return "\n".join(lines) + "\n"


def _comment(spec: ParameterSpec) -> str:
    facts = [spec.unit, spec.bounds_text, " | ".join(spec.choices), spec.source]
    if spec.effect != "keeps":
        facts.append(f"a change {EFFECTS[spec.effect]}")
    if spec.read_only:
        facts.append("set at start-up only")
    notes = "; ".join(fact for fact in facts if fact)
    return spec.doc + (f" [{notes}]" if notes else "")


def _scalar(value: Value) -> str:
    text: str = yaml.safe_dump(value, default_flow_style=True, width=10**6)
    return text.splitlines()[0]


def read_yaml(path: Path, node_name: str) -> dict[str, object]:
    """Read the parameters that the file at `path` has for the node `node_name`.

    Later sections win, as in ROS. `node_name` is a node's full name, with a leading slash, which
    sections name by ROS's rules; or a name alone, which the last part of a section may be, in any
    namespace.

    Raises
    ------
    InputError
        If there is no such file, it is not valid YAML, or it has no `ros__parameters` for this
        node.
    """
    document = read_yaml_file(path, "parameter file")
    sections = list(_sections(document, ""))
    if not sections:
        raise InputError(
            f"the parameter file {path} has no ros__parameters section; "
            "`vehicle-pf-tracker params VARIANT` prints one to start from"
        )
    chosen = [body for name, body in sections if _is_for(name, node_name)]
    if not chosen:
        names = ", ".join(name for name, _ in sections)
        raise InputError(
            f"the parameter file {path} has nothing for {node_name}, only for {names}; "
            "use /** as the node name to address any"
        )
    merged: dict[str, object] = {}
    for body in chosen:
        merged.update(flatten(body))
    return merged


def _is_for(section: str, node_name: str) -> bool:
    """Test whether a section is one of a node's."""
    parts = section.strip("/").split("/")
    if not node_name.startswith("/"):
        return parts[-1] in {node_name, "*", "**"}
    # Of ROS's wildcards, one star is a part of the name, and two are any number of them.
    wildcards = {"*": r"/\w+", "**": r"(/\w+)*"}
    pattern = "".join(wildcards.get(part, f"/{re.escape(part)}") for part in parts)
    return re.fullmatch(pattern, node_name) is not None


def _sections(document: Any, prefix: str) -> Iterable[tuple[str, Mapping[str, Any]]]:
    """Yield each section of a document: its name, and its parameters."""
    if not isinstance(document, Mapping):
        return
    for key, body in document.items():
        name = f"{prefix}/{str(key).strip('/')}"
        if not isinstance(body, Mapping):
            continue
        inner = body.get("ros__parameters")
        if isinstance(inner, Mapping):
            yield name, inner
        yield from _sections({k: v for k, v in body.items() if k != "ros__parameters"}, name)


def flatten(body: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    """Return nested parameters by dotted name."""
    flat: dict[str, object] = {}
    for key, value in body.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            flat.update(flatten(value, name + "."))
        else:
            flat[name] = value
    return flat
