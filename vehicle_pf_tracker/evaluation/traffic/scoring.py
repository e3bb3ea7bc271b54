# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scores of many vehicles, and the baselines.

A `baseline_worker` has TrackEval's scores and the baselines. What can be scored, identities kept
through total occlusions and vehicles counted are found here.
"""

from __future__ import annotations

from collections import Counter as Tally
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, intersections
from vehicle_pf_tracker.core.overlaps import overlaps as overlaps_of_edges
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.evaluation.baseline_process import Worker
from vehicle_pf_tracker.evaluation.traffic.sequence import EVERY_FRAME, TrafficSequence
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

MATCH = 0.5
"""Least overlap (intersection over union) of boxes that belong to each other: MOTChallenge's."""

_MOST_INSIDE = 0.5
"""Share of an unmatched box in a region without truth above which it is left out: most of it is
not known to be wrong."""
_WINDOW = 30
"""Frames before and after an occlusion in which the identity is looked for: a second at 30 Hz."""
_GLIMPSE = 5
"""Frames in sight below which two occlusions are one, a choice: a gap between two posts."""
_LEAST = 10
"""Frames in sight before an occlusion from which a tracker can know the vehicle, a choice: a
third of a second at 30 Hz."""
_LOW = 0.25
"""Threshold of scores that suits CenterNet's on cdnet_highway, which span 0.15 to 0.74. It was
chosen by hand for that detector; the defaults of 0.6 and 0.7 discard nearly all of its boxes."""


def scorable(sequence: TrafficSequence, tracks: Array) -> tuple[Array, Array]:
    """Leave out what cannot be scored.

    Truth ends at the image's borders, and so boxes are cut there; those outside are left out.
    Totally hidden vehicles are not scored. A track's box that belongs to no vehicle in sight is
    left out where it belongs to a hidden one, or where most of it lies in a region without truth.

    Parameters
    ----------
    sequence : TrafficSequence
        Scene with truth.
    tracks : array, shape (N, 6) or wider
        Frame, identity, left, top, width and height of the tracks' boxes.

    Returns
    -------
    truth, tracks : array, shape (M, 6)
        Boxes to be scored.
    """
    # Cut first: regions and overlaps are of what is in the image, as the truth is.
    tracks = _cut(tracks[:, :6], sequence.size)
    left = np.ones(len(tracks), dtype=np.bool_)
    for frame in range(1, sequence.frame_count + 1):
        rows = np.flatnonzero(tracks[:, 0] == frame)
        left[rows] = _counts(sequence, frame, tracks[rows, 2:6])
    return sequence.truth[~sequence.hidden], tracks[left]


def _cut(tracks: Array, size: tuple[int, int]) -> Array:
    # A vehicle that drives out is tracked beyond the border, where the truth ends.
    low = np.maximum(tracks[:, 2:4], 0)
    high = np.minimum(tracks[:, 2:4] + tracks[:, 4:6], size)
    inside = (high > low).all(axis=1)
    cut: Array = np.hstack([tracks[:, :2], low, high - low])[inside]
    return cut


def _counts(sequence: TrafficSequence, frame: int, boxes: Array) -> npt.NDArray[np.bool_]:
    """Mark the boxes of one frame that are scored."""
    now = sequence.truth[:, 0] == frame
    in_sight = sequence.truth[now & ~sequence.hidden, 2:]
    hidden = sequence.truth[now & sequence.hidden, 2:]
    # Vehicles in sight come first: a box that fits one of them is scored, whatever is behind.
    free = np.ones(len(boxes), dtype=np.bool_)
    free[matches(in_sight, boxes)[1]] = False
    spare = np.flatnonzero(free)
    left_out = np.zeros(len(boxes), dtype=np.bool_)
    left_out[spare[matches(hidden, boxes[spare])[1]]] = True
    # Regions of this frame, and those of all.
    regions = sequence.ignored[np.isin(sequence.ignored[:, 0], (EVERY_FRAME, frame)), 1:]
    common = intersections(_edges(boxes)[:, None], _edges(regions))
    inside = common > _MOST_INSIDE * boxes[:, 2:].prod(axis=1)[:, None]
    left_out |= free & inside.any(axis=1)
    return ~left_out


def matches(first: Array, second: Array) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Match boxes one to one so that the sum of overlaps of at least `MATCH` is largest.

    Returns
    -------
    array of int, array of int
        Indices into `first` and `second`.
    """
    overlap = overlaps(first, second)
    # Below the limit worth nothing: else a pair too far apart could break two good ones.
    overlap[overlap < MATCH] = 0
    rows, columns = linear_sum_assignment(-overlap)
    good = overlap[rows, columns] > 0
    return rows[good], columns[good]


def overlaps(first: Array, second: Array) -> Array:
    """Intersection over union of each pair of boxes (left, top, width, height)."""
    return overlaps_of_edges(_edges(first)[:, None], _edges(second))


def _edges(boxes: Array) -> Array:
    return np.hstack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]])


_SETTLED_NS = 2 * 10**9
"""Time in ns before which crossings are not counted, a choice: who is on the line when a clip
begins has no past."""


def kept_identities(sequence: TrafficSequence, tracks: Array) -> tuple[int, int]:
    """Count total occlusions after which a vehicle has the identity that it had before.

    Before is the identity of the last box on the vehicle within `_WINDOW` frames, after is the one
    that most boxes on it have within as many. A vehicle that is not followed before or after has
    not kept its identity.

    Returns
    -------
    kept, judged : int
        Occlusions of vehicles that were in sight for `_LEAST` frames before.
    """
    # Matched once per frame: an occlusion is then judged by looking up.
    followed = _followed(sequence, tracks)
    kept = judged = 0
    for vehicle in np.unique(sequence.truth[:, 1]).tolist():
        rows = sequence.truth[:, 1] == vehicle
        seen = sequence.truth[rows & ~sequence.hidden, 0].astype(int).tolist()
        hidden = set(sequence.truth[rows & sequence.hidden, 0].astype(int).tolist())
        spells = list(_spells(seen, hidden))
        for before, after in pairwise(spells):
            # A tracker that never had time to know the vehicle has nothing to keep.
            if len(before) >= _LEAST:
                judged += 1
                first, then = (
                    [followed[at, vehicle] for at in frames if (at, vehicle) in followed]
                    for frames in (before[-_WINDOW:], after[:_WINDOW])
                )
                # The last before, as that is what was hidden; the most frequent after, as one
                # wrong box there is no lost identity.
                kept += bool(first and then) and Tally(then).most_common(1)[0][0] == first[-1]
    return kept, judged


def _spells(seen: list[int], hidden: set[int]) -> Iterator[list[int]]:
    """Divide frames in sight at total occlusions; glimpses between two are left out."""
    spell: list[int] = []
    # Only hidden frames between two sightings divide them: one without truth does not.
    for frame, before in zip(seen, [None, *seen], strict=False):
        if before is not None and any(number in hidden for number in range(before + 1, frame)):
            # Too short to be followed: the occlusions before and after it are one.
            if len(spell) >= _GLIMPSE:
                yield spell
            spell = []
        spell.append(frame)
    if len(spell) >= _GLIMPSE:
        yield spell


def _followed(sequence: TrafficSequence, tracks: Array) -> dict[tuple[int, int], int]:
    """Identity of the track on each vehicle in sight, by frame and vehicle."""
    found: dict[tuple[int, int], int] = {}
    for frame in range(1, sequence.frame_count + 1):
        truth = sequence.truth[(sequence.truth[:, 0] == frame) & ~sequence.hidden]
        boxes = tracks[tracks[:, 0] == frame]
        for row, column in zip(*matches(truth[:, 2:], boxes[:, 2:6]), strict=True):
            found[frame, int(truth[row, 1])] = int(boxes[column, 1])
    return found


def counts(sequence: TrafficSequence, tracks: Array) -> tuple[int, int]:
    """Count crossings of a line through the middle of the image, after the first two seconds.

    Returns
    -------
    counted, true : int
        Crossings of the tracks and of the true boxes, in both directions.
    """
    line = _line(sequence)
    return _crossings(sequence, tracks, line), _crossings(sequence, sequence.truth, line)


def _line(sequence: TrafficSequence) -> CountingLine:
    """Return the line through the middle that most of the true motion crosses."""
    width, height = map(float, sequence.size)
    moved = np.zeros(2)
    for vehicle in np.unique(sequence.truth[:, 1]):
        boxes = sequence.truth[sequence.truth[:, 1] == vehicle, 2:]
        moved += np.abs(boxes[-1, :2] - boxes[0, :2])
    # Sums over all vehicles: an upright line for traffic across the image.
    if moved[0] > moved[1]:
        return CountingLine("middle", (width / 2, 0.0), (width / 2, height))
    return CountingLine("middle", (0.0, height / 2), (width, height / 2))


def _crossings(sequence: TrafficSequence, tracks: Array, line: CountingLine) -> int:
    counter = Counter(CountingPlan(lines=(line,)))
    # In the order of identities, so that truth and tracks are counted alike.
    order = np.argsort(tracks[:, 1], kind="stable")
    rows = tracks[order]
    total = 0
    for frame in range(1, sequence.frame_count + 1):
        now = rows[rows[:, 0] == frame]
        estimates = [as_estimate(row) for row in now.tolist()]
        crossings = counter.update(estimates, round(frame * 1e9 / sequence.frame_rate))
        # The counter follows from the first frame; only its crossings of before are left out.
        total += sum(one.stamp_ns >= _SETTLED_NS and not one.doubt for one in crossings)
    return total


def as_estimate(row: list[float]) -> TrackEstimate:
    """Take a row (frame, identity, left, top, width, height) for a vehicle in sight."""
    return TrackEstimate(
        identity=int(row[1]),
        box=Box(*row[2:6]),
        velocity=(0.0, 0.0),
        mode=TrackMode.TRACKING,
        confidence=1.0,
        label="",
        score=1.0,
        age=1.0,
        hidden_by=None,
        serial=int(row[1]),
    )


_BOTH_LOW = {"track_activation_threshold": _LOW, "high_conf_det_threshold": _LOW}
TRAFFIC_BASELINES: Mapping[str, Mapping[str, float]] = {
    "sort": {},
    "sort-low": {"track_activation_threshold": 0.15},
    "bytetrack": {},
    "bytetrack-low": _BOTH_LOW,
    "ocsort": {},
    "ocsort-low": {"high_conf_det_threshold": _LOW},
    "cbiou": {},
    "cbiou-low": _BOTH_LOW,
}
"""Options of trackers of PyPI `trackers`: as they come, and with thresholds lowered by hand."""


class TrafficWorker(Worker):
    """A process that scores tracks and runs `TRAFFIC_BASELINES`.

    Parameters
    ----------
    python : Path or None
        Interpreter that has TrackEval and `trackers`; None looks where `baseline_python` says.

    Raises
    ------
    InputError
        If there is no such interpreter, or it lacks a library.
    """

    def __init__(self, python: Path | None = None) -> None:
        super().__init__("the traffic baselines", python, ["traffic"])

    def score(self, sequence: TrafficSequence, tracks: Array) -> dict[str, float]:
        """Score tracks (frame, identity, left, top, width, height) against a scene's truth.

        Returns
        -------
        dict of str to float
            HOTA, DetA, AssA, LocA, IDF1 and MOTA in percent; IDSW, Frag, FP and FN as counts.
        """
        truth, rows = scorable(sequence, tracks)
        content = {"truth": truth.tolist(), "tracks": rows.tolist()}
        answer: dict[str, float] = self._task("score", sequence, content)
        return answer

    def track(self, name: str, sequence: TrafficSequence, detections: Array) -> tuple[Array, float]:
        """Follow all vehicles with one of `TRAFFIC_BASELINES`.

        Returns
        -------
        tracks : array, shape (N, 6)
            Frame, identity, left, top, width, height.
        seconds : float
            Processor time per frame, s.
        """
        content = {
            "tracker": name.removesuffix("-low"),
            "options": {**TRAFFIC_BASELINES[name], "frame_rate": sequence.frame_rate},
            "detections": detections.tolist(),
        }
        answer = self._task("track", sequence, content)
        tracks = np.asarray(answer["tracks"], dtype=np.float64).reshape(-1, 6)
        return tracks, answer["seconds"] / sequence.frame_count

    def _task(self, task: str, sequence: TrafficSequence, content: dict[str, Any]) -> Any:
        return self._ask({task: {"frames": sequence.frame_count, **content}})
