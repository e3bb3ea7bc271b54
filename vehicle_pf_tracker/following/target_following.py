# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Given vehicles followed through a source, recorded and drawn as they go."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from vehicle_pf_tracker.following.live_facts import target_facts
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker, with_next
from vehicle_pf_tracker.results.estimates import EstimateRow, start_of_clock
from vehicle_pf_tracker.showing.estimates_recording import OnFrame
from vehicle_pf_tracker.showing.live_page import LivePage
from vehicle_pf_tracker.showing.pictures import Numbered, Pictures
from vehicle_pf_tracker.showing.target_drawing import Annotator, TargetState, frame_with_targets


def follow_targets(
    trackers: Mapping[str, OfflineTracker],
    frames: Numbered,
    pictures: Pictures,
    on_frame: OnFrame | None = None,
    page: LivePage | None = None,
) -> dict[str, list[EstimateRow]]:
    """Track every target through the same frames, each decoded once.

    Parameters
    ----------
    trackers : mapping of str to OfflineTracker
        By the names of their targets.
    frames : iterator of (int, StampedFrame)
        Frames with their numbers, which follow each other.
    pictures : Pictures
        Pictures to make meanwhile.
    on_frame : callable or None
        Takes each frame with its rows.
    page : LivePage or None
        Page to show them on.

    Returns
    -------
    dict of str to list of EstimateRow
        The rows of each target.

    Raises
    ------
    InputError
        If a target is invalid in its frame, or the video cannot be written.
    """
    rows: dict[str, list[EstimateRow]] = {name: [] for name in trackers}
    annotators = _annotators(list(trackers), pictures)
    start_ns: int | None = None
    with pictures.drawing(frames) as (take, all_frames):
        for (number, current), later in with_next(all_frames):
            is_first = start_ns is None
            start_ns = start_of_clock(start_ns, current.stamp_ns)
            # 1. The row of each target.
            states: list[TargetState] = []
            for name, tracker in trackers.items():
                row = tracker.row(number, current, later and later[1], is_first=is_first)
                rows[name].append(row)
                annotators[name].follow(tracker.estimate)
                states.append((annotators[name], row, tracker.estimate))
            of_frame = {name: of_target[-1] for name, of_target in rows.items()}
            # 2. A recording takes every frame, pictures those that can be read.
            if on_frame is not None:
                on_frame(current, of_frame)
            if current.frame is not None:
                elapsed_ns = current.stamp_ns - start_ns
                draw = partial(frame_with_targets, current.frame, elapsed_ns, states)
                modes = tuple(row.mode for row in of_frame.values())
                take(modes, draw, current.frame, current.stamp_ns)
                on_page = partial(frame_with_targets, current.frame, None, states)
                pictures.show(page, on_page, partial(target_facts, of_frame, elapsed_ns))
    for tracker in trackers.values():
        tracker.check_started()
    return rows


def _annotators(names: Sequence[str], pictures: Pictures) -> dict[str, Annotator]:
    """Make what draws each target; a single one needs no name in the picture."""
    is_single = len(names) == 1
    return {
        name: Annotator("" if is_single else name, particles=pictures.particles) for name in names
    }
