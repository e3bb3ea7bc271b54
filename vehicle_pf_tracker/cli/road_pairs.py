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

"""Files of pixels and the points of the road that they show."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.output_files import write_text
from vehicle_pf_tracker.road.calibration import parse_pairs
from vehicle_pf_tracker.road.plane import Pair

FORM = "pairs: [{pixel: [u, v], road: [x, y]}, …]"


def read_pairs(path: Path) -> tuple[Pair, ...]:
    """Read pairs from a YAML file.

    Raises
    ------
    InputError
        If it cannot be read, or is not of the form that the help says.
    """
    try:
        document: Any = yaml.safe_load(path.read_text(encoding="utf-8"))
        words = [
            ",".join(str(float(one)) for one in row["pixel"])
            + "="
            + ",".join(str(float(one)) for one in row["road"])
            for row in document["pairs"]
        ]
    except OSError as error:
        raise InputError(f"cannot read the pairs {path}: {error.strerror}") from None
    except (yaml.YAMLError, ValueError, TypeError, KeyError, RecursionError):
        raise InputError(f"the file {path} has no pairs of the form {FORM}") from None
    return parse_pairs(";".join(words))


def write_pairs(path: Path, pairs: Sequence[Pair]) -> None:
    """Write a file that `read_pairs` reads."""
    rows = [{"pixel": list(pair.pixel), "road": list(pair.road)} for pair in pairs]
    text = yaml.safe_dump({"pairs": rows}, sort_keys=False, default_flow_style=None)
    write_text(path, text)
