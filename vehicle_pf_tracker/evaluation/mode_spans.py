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

"""Modes of a run as stretches of time, for people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.trackers.estimate import Mode

_MOST_SPANS = 12
"""Spans in a summary; more are counted, since nobody reads a line of hundreds."""


@dataclass(frozen=True, slots=True)
class ModeSpan:
    """Consecutive frames of one mode.

    Attributes
    ----------
    mode : str
        The mode.
    first, last : EstimateRow
        Rows of its first and its last frame.
    """

    mode: str
    first: EstimateRow
    last: EstimateRow


def mode_spans(rows: Sequence[EstimateRow]) -> list[ModeSpan]:
    """Group consecutive rows of one mode."""
    groups = ((mode, list(group)) for mode, group in groupby(rows, key=lambda row: row.mode))
    return [ModeSpan(mode, group[0], group[-1]) for mode, group in groups]


def summary(rows: Sequence[EstimateRow]) -> str:
    """Return the modes of a run in one sentence, times in min:s after its first frame."""
    if not rows:
        return "no frames"
    spans, start = mode_spans(rows), rows[0].stamp_ns
    words = [_words(span, start, is_last=span is spans[-1]) for span in spans[:_MOST_SPANS]]
    if len(spans) > _MOST_SPANS:
        words.append(f"and {len(spans) - _MOST_SPANS} more changes of the mode")
    tracked = sum(row.mode == Mode.TRACKING.value for row in rows)
    return f"{', '.join(words)}; {tracked} of {len(rows)} frames tracked"


def clock_words(nanoseconds: int) -> str:
    """Return a time as min:s with tenths, as ``1:07.5``."""
    tenths = round(nanoseconds / 1e8)
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def _words(span: ModeSpan, start: int, *, is_last: bool) -> str:
    first, last = (clock_words(row.stamp_ns - start) for row in (span.first, span.last))
    if is_last and span.mode == Mode.LOST.value:
        return f"LOST from {first}"
    return f"{span.mode} {first}-{last}"
