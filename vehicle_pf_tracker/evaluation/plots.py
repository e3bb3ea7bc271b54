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

"""Figures of runs, readable in grey and for colour-blind readers."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import NamedTuple

from matplotlib import rc_context
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.offline.output_files import replacing


class Style(NamedTuple):
    """Colour, line and marker of one series."""

    colour: str
    line: str | tuple[int, tuple[int, ...]]
    marker: str


# The colours are Okabe and Ito's. Lines tell series apart over time, markers on paths.
STYLES = (
    Style("#0072B2", "-", "o"),
    Style("#D55E00", "--", "s"),
    Style("#009E73", "-.", "^"),
    Style("#CC79A7", ":", "D"),
    Style("#E69F00", (0, (5, 1, 1, 1, 1, 1)), "v"),
    Style("#56B4E9", (0, (8, 2)), "P"),
)
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


def stretches(truths: Mapping[int, Truth], kinds: Collection[Occlusion]) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with an occlusion of these kinds.

    Truths are given by the number of their frame.
    """
    grouped = itertools.groupby(sorted(truths), lambda number: truths[number].occlusion in kinds)
    found = [list(numbers) for matches, numbers in grouped if matches]
    return [(numbers[0], numbers[-1]) for numbers in found]
