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

"""Figures in files."""

from __future__ import annotations

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from vehicle_pf_tracker.results.output_files import replacing

_DPI = 150


def save(figure: Figure, path: Path) -> None:
    """Write `figure` to the file `path`, whose suffix names the format.

    The same figure gives the same file: no date is written, and names within it are not random.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    metadata = {"Date": None} if path.suffix == ".svg" else {}
    with replacing(path) as partial, rc_context({"svg.hashsalt": "vehicle_pf_tracker"}):
        figure.savefig(partial, dpi=_DPI, metadata=metadata)
