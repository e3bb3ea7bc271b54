# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Several trackers on one drive in turns."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from benchmarks.bench.material import drive, enlarged
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.baselines import Baseline
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import find_variant

TURN_FRAMES = 10
"""Frames of a turn: as in a recording that is tracked at full speed, and not once in a while."""


class Follower(Protocol):
    """Something that follows the vehicle, and tells what each frame cost it."""

    def start(self, frame: Frame, box: Box, seed: int) -> None:
        """Begin on `box`."""
        ...

    def step(self, frame: Frame) -> float:
        """Follow into the next frame; CPU seconds of the one thread that works."""
        ...

    @property
    def centre(self) -> tuple[float, float]:
        """Estimated position of the vehicle, px."""
        ...


class Own:
    """Trackers of one variant; with several, a step is theirs together and its cost the share.

    Parameters
    ----------
    name : str
        Name of the variant.
    settings : mapping
        Parameters over the defaults.
    count : int
        Trackers in this process.
    size : str or None
        Size that the frames are enlarged to, one of `FRAME_SIZES`; None takes them as they are.
    """

    def __init__(
        self,
        name: str,
        settings: Mapping[str, Any] | None = None,
        *,
        count: int = 1,
        size: str | None = "vga",
    ) -> None:
        self._variant = find_variant(name)
        self._settings = settings or {}
        self._count = count
        self._size = size
        self._trackers: list[Any] = []

    def start(self, frame: Frame, box: Box, seed: int) -> None:
        """Begin on `box`, every tracker with a seed of its own."""
        parameters = [
            from_mapping(self._variant.parameters, {**self._settings, "seed": seed + number})
            for number in range(self._count)
        ]
        self._trackers = [self._variant.tracker(own) for own in parameters]
        for tracker in self._trackers:
            tracker.start(self._shown(frame), box)
        self.centre = box.centre

    def step(self, frame: Frame) -> float:
        """Follow into the next frame."""
        # Enlarged outside of the measured time.
        image = self._shown(frame)
        before = time.thread_time()
        for tracker in self._trackers:
            estimate = tracker.step(image)
        seconds = time.thread_time() - before
        self.centre = estimate.position
        # One of several has its share of what all take.
        return seconds / self._count

    def _shown(self, frame: Frame) -> Frame:
        return frame if self._size is None else enlarged(frame, self._size)


class Theirs:
    """A baseline, whose own process does the work."""

    def __init__(self, baseline: Baseline) -> None:
        self._baseline = baseline

    def start(self, frame: Frame, box: Box, seed: int) -> None:
        """Begin on `box`; a baseline has no seed."""
        self.centre = self._baseline.start(frame, box).box.centre

    def step(self, frame: Frame) -> float:
        """Follow into the next frame."""
        answer = self._baseline.step(frame)
        self.centre = answer.box.centre
        return answer.seconds


def follow(
    followers: Mapping[str, Follower], seeds: Sequence[int], most_frames: int
) -> tuple[dict[str, list[float]], dict[str, float]]:
    """Let all follow the vehicle in turns of `TURN_FRAMES` frames; each turn another one begins.

    Parameters
    ----------
    followers : mapping of str to Follower
        Followers by name.
    seeds : sequence of int
        One pass over the drive for each.
    most_frames : int
        Number of frames of a pass.

    Returns
    -------
    dict of str to list of float, dict of str to float
        Mean seconds of the steps of each turn; and the share of frames in which the error was
        below half the vehicle's diagonal.
    """
    shown, boxes = drive()
    names = list(followers)
    times: dict[str, list[float]] = {name: [] for name in names}
    hits: dict[str, list[bool]] = {name: [] for name in names}
    for seed in seeds:
        for follower in followers.values():
            follower.start(shown[0], boxes[0], seed)
        # Whole turns only: a shorter one would have cold caches for most of its frames.
        for first in range(1, min(len(shown), most_frames) - TURN_FRAMES + 1, TURN_FRAMES):
            # Another one begins each turn: the first may find the caches of the last.
            turn = first // TURN_FRAMES % len(names)
            for name in names[turn:] + names[:turn]:
                seconds = 0.0
                for index in range(first, first + TURN_FRAMES):
                    # Judged outside of the time that a follower reports.
                    seconds += followers[name].step(shown[index])
                    hits[name].append(_is_close(followers[name].centre, boxes[index]))
                times[name].append(seconds / TURN_FRAMES)
    return times, {name: sum(hits[name]) / len(hits[name]) for name in names}


def _is_close(centre: tuple[float, float], box: Box) -> bool:
    across = centre[0] - box.centre[0], centre[1] - box.centre[1]
    return 4 * (across[0] ** 2 + across[1] ** 2) < box.diagonal**2
