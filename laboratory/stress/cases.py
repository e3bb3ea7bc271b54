# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A case of the battery: a small frozen description, from which its frames are made when asked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from laboratory.stress.changes import Change
from laboratory.stress.footage import StressSource, open_footage
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.footage import stamp_of
from vehicle_pf_tracker.scenes.random_streams import stream


@dataclass(frozen=True, slots=True)
class Start:
    """Displacement of the first box, in its widths and heights, and the factor of its sides."""

    name: str = ""
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def box(self, true: Box) -> Box:
        """Return the box to start on."""
        # The very box of the truth: by way of its centre it would be rounded.
        if self == TRUE_START:
            return true
        x, y = true.centre
        centre = x + self.shift[0] * true.width, y + self.shift[1] * true.height
        return Box.around(centre, true.width * self.scale, true.height * self.scale)


TRUE_START = Start()
"""The true box."""


class StressFrame(NamedTuple):
    """A frame of a case.

    Attributes
    ----------
    frame : (H, W, 3) array of uint8
        RGB image.
    elapsed : float
        Nominal frame periods since the frame before; 1.0 in the first.
    truth : Truth or None
        True state, stamped in the case's own time; None where the sequence has no truth.
    """

    frame: Frame
    elapsed: float
    truth: Truth | None


@dataclass(frozen=True, slots=True)
class Case:
    """A sequence, which of its frames, from which box, and what is changed in them.

    Attributes
    ----------
    origin : StressSource
        The sequence and its camera.
    kind : str
        Name of what is tested, one of `kinds.STRESS_KINDS`.
    variation : str
        Name of the case within its kind.
    first, count, step : int
        Frames of the sequence by index: `count` of them from `first` on, every `step`-th; a
        negative step plays backwards.
    seed : int
        Seed of everything random in the case.
    labels : tuple of (str, str)
        Properties to group results by, such as ``("path", "turning")``.
    start : Start
        Shift and scale of the box to start on.
    changes : tuple of Change
        Changes of the images, applied in this order.
    dropped : float
        Share of the frames after the first that are missing.
    """

    origin: StressSource
    kind: str
    variation: str
    first: int
    count: int
    step: int = 1
    seed: int = 0
    labels: tuple[tuple[str, str], ...] = ()
    start: Start = TRUE_START
    changes: tuple[Change, ...] = field(default=())
    dropped: float = 0.0

    @property
    def name(self) -> str:
        """Name of the case, unique in its battery."""
        return "/".join(part for part in (self.origin.name, self.kind, self.variation) if part)

    @property
    def sequence(self) -> str:
        """Name of the sequence."""
        return self.origin.name

    @property
    def camera(self) -> str:
        """Name of the camera."""
        return self.origin.camera

    @property
    def fps(self) -> float:
        """Nominal frames per second."""
        # Every second frame of 30 frames/s is 15 frames/s.
        return open_footage(self.origin.source).fps / abs(self.step)

    def label(self, name: str) -> str:
        """Return the label `name`; empty where the case has none."""
        return dict(self.labels).get(name, "")

    def truths(self) -> list[Truth | None]:
        """Compute the truth of every frame, without decoding one."""
        footage = open_footage(self.origin.source)
        fps = self.fps
        return [
            self._truth(footage.truth[index], index, stamp_of(position, fps))
            for position, index in self._kept()
        ]

    def start_box(self) -> Box:
        """Return the box to start on in the first frame."""
        footage = open_footage(self.origin.source)
        truth = self._truth(footage.truth[self.first], self.first, 0)
        assert truth is not None, "a case begins in a frame with truth"
        return self.start.box(truth.box)

    def play(self) -> Iterator[StressFrame]:
        """Make the frames, one after the other."""
        footage = open_footage(self.origin.source)
        fps = self.fps
        painters = [change.painter(footage, self.seed) for change in self.changes]
        # So that the first frame, at position 0, has an elapsed time of 1.
        last = -1
        for position, index in self._kept():
            frame = footage.frame(index)
            for paint in painters:
                frame = paint(frame, index)
            truth = self._truth(footage.truth[index], index, stamp_of(position, fps))
            yield StressFrame(frame, float(position - last), truth)
            last = position

    def _kept(self) -> Iterator[tuple[int, int]]:
        """Yield the position in the case and the index in the sequence of each frame kept."""
        # A draw for every position, dropped or not: another share drops more of the same frames.
        draws = stream(self.seed, "dropped").random(self.count)
        for position in range(self.count):
            if position == 0 or draws[position] >= self.dropped:
                yield position, self.first + self.step * position

    def _truth(self, truth: Truth | None, index: int, stamp_ns: int) -> Truth | None:
        if truth is None:
            return None
        source = self.origin.source
        # Each change sees the size that those before it made.
        size = source.width, source.height
        for change in self.changes:
            truth = change.truth(truth, index, size, self.seed)
            size = change.size(size)
        return replace(truth, stamp_ns=stamp_ns)
