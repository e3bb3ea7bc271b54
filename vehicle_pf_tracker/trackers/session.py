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

"""One target followed through one stream of stamped images.

Offline runs and the node both drive their tracker through a session, and so give the same
estimates.
"""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.clock import StampClock, StampEvent, Tick
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import CodedFrame, Frame, check_frame, frame_size
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.trackers.base import DEFAULT_PERIOD, BaseTracker
from vehicle_pf_tracker.trackers.continuity import Continuation, Continuity, StrayImageError
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.registry import Variant


class TargetError(InputError):
    """Target that no tracker can start on in the image that it was given for."""


class Session:
    """Control of one variant's tracker: start, steps, restarts.

    One odd image, of another size or out of its time, is rejected and kept aside. If the next one
    agrees with it, the stream has changed: the tracker then processes both, and only the first
    one's estimate is missing. An image whose stamp proves to have been ahead when the next
    one comes is taken back, as if it had never come.

    Parameters
    ----------
    variant : Variant
        Variant from the registry.
    parameters : Any
        Instance of `variant.parameters`.
    settings : SessionParameters
        Parameters of the stream, the configured target among them.

    Attributes
    ----------
    events : list of str
        Irregularities of the last frame, for logs and diagnostics.
    """

    def __init__(
        self, variant: Variant, parameters: Any, settings: SessionParameters | None = None
    ) -> None:
        self.variant = variant
        self.settings = settings or SessionParameters()
        self.events: list[str] = []
        self.tracker = variant.tracker(parameters)
        self._clock = StampClock(parameters.frame_rate)
        self._continuity = Continuity()
        self._aside: tuple[Frame | CodedFrame, int] | None = None
        self._backup: tuple[StampClock, BaseTracker[Any]] | None = None
        self._pending: Box | None = self.settings.target.box
        self._size: tuple[int, int] | None = None

    @property
    def waiting(self) -> bool:
        """True while there is no target to follow."""
        return self._size is None and self._pending is None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height in px that images are expected to have; None for any size."""
        return self._continuity.size

    def set_target(self, box: Box) -> None:
        """Start, or start again, on `box` in the next accepted frame."""
        self._pending = box

    def reset(self) -> None:
        """Go back to the configured target, or to waiting for one, and discard the track."""
        self._clock = StampClock(self.tracker.parameters.frame_rate)
        self._continuity, self._aside, self._backup = Continuity(), None, None
        self._size, self._pending = None, self.settings.target.box

    def reconfigure(self, parameters: Any, settings: SessionParameters) -> None:
        """Take new parameters between two frames; a changed target starts on it."""
        if settings.target != self.settings.target:
            self._pending = settings.target.box
        self.settings = settings
        self.tracker.reconfigure(parameters)
        self._clock.set_frame_rate(parameters.frame_rate)

    def feed(self, image: Frame | CodedFrame, stamp_ns: int) -> Estimate | None:
        """Take the next image; None while there is no target.

        Parameters
        ----------
        image : (H, W, 3) array or CodedFrame
            RGB; not written to, and copied where it has to be kept. A coded one is decoded only if
            it continues the stream, or the next one agrees with it.
        stamp_ns : int
            The image's stamp in ns.

        Raises
        ------
        StrayImageError
            If the image does not continue the stream; the track is kept.
        TargetError
            If the target to start on is not valid in it. Where there is a track, such a target is
            reported in `events` instead, and the track continues.
        InputError
            If the frame is not usable.
        """
        self.events = []
        aside, self._aside = self._aside, None
        if aside is not None and _size(aside[0]) == _size(image):
            image = _decoded(image)
        try:
            continuation = self._continuity.judge(
                _size(image), stamp_ns, timed=self._size is not None
            )
        except StrayImageError:
            self._aside = image.copy() if isinstance(image, np.ndarray) else image, stamp_ns
            raise
        if continuation is Continuation.CONFIRMS and aside is not None:
            self._take_aside(*aside)
        if continuation is Continuation.CORRECTS:
            self._take_back()
        self._backup = self._copied() if continuation is Continuation.LEAPS else None
        is_timed = continuation is not Continuation.UNTIMED
        return self._take(_decoded(image), stamp_ns if is_timed else None)

    def _take_aside(self, image: Frame | CodedFrame, stamp_ns: int) -> None:
        """Take the rejected image after all, unless it proves to be damaged."""
        try:
            frame = _decoded(image)
        except InputError:
            return
        self._take(frame, stamp_ns)

    def _copied(self) -> tuple[StampClock, BaseTracker[Any]]:
        """Copy what an image changes; kernels have no state of their own."""
        kernels = self.tracker.kernels
        return copy.deepcopy((self._clock, self.tracker), {id(kernels): kernels})

    def _take_back(self) -> None:
        """Go back to before the last image, whose stamp was ahead."""
        self.events.append("the last image's stamp was ahead; its estimate is taken back")
        parameters = self.tracker.parameters
        if self._backup is None:  # it started the target, and its stamp is all that was wrong
            self._clock = StampClock(parameters.frame_rate)
            return
        self._clock, self.tracker = self._backup
        self._clock.set_frame_rate(parameters.frame_rate)
        if self.tracker.parameters != parameters:
            self.tracker.reconfigure(parameters)

    def _take(self, frame: Frame, stamp_ns: int | None) -> Estimate | None:
        size, tick = frame_size(frame), self._tick(stamp_ns)
        if self._size is not None and size != self._size:
            self.events.append(
                f"image size changed from {self._size[0]}x{self._size[1]} to {size[0]}x{size[1]}; "
                "starting again on the configured target"
            )
            self._discard_track()
        self.tracker.frame_period = self._clock.period or DEFAULT_PERIOD
        box, self._pending = self._pending, None
        if box is not None and self._is_usable(box, size):
            return self._start(frame, box, size)
        return None if self._size is None else self.tracker.step(frame, tick.elapsed)

    def _tick(self, stamp_ns: int | None) -> Tick:
        if stamp_ns is None:
            self.events.append(StampEvent.UNUSABLE.value)
            return Tick(1.0, StampEvent.UNUSABLE)
        tick = self._clock.tick(stamp_ns)
        if tick.event is not None:
            self.events.append(tick.event.value)
        if tick.event is StampEvent.JUMP_BACK and self.settings.reset_on_time_jump:
            self._clock = StampClock(self.tracker.parameters.frame_rate)
            self._discard_track()
            tick = self._clock.tick(stamp_ns)
        return tick

    def _is_usable(self, box: Box, size: tuple[int, int]) -> bool:
        try:
            check_target(box, *size)
        except InputError as error:
            if self._size is None:
                raise TargetError(str(error)) from None
            self.events.append(f"target refused: {error}")
            return False
        return True

    def _start(self, frame: Frame, box: Box, size: tuple[int, int]) -> Estimate:
        estimate = self.tracker.start(frame, box)
        self._size, self._backup = size, None
        return estimate

    def _discard_track(self) -> None:
        # A box that was just set is newer than the one configured.
        self._size = None
        self._pending = self._pending or self.settings.target.box


def _size(image: Frame | CodedFrame) -> tuple[int, int]:
    return frame_size(check_frame(image)) if isinstance(image, np.ndarray) else image.size


def _decoded(image: Frame | CodedFrame) -> Frame:
    return image if isinstance(image, np.ndarray) else image.decode()
