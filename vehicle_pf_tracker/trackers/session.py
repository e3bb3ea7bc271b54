# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Session: one target followed through one stream of stamped images.

Offline runs and the node both drive their tracker through a session, and so give the same
estimates.
"""

from __future__ import annotations

import copy
from functools import partial
from typing import Any

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.trackers.attempts import Attempts
from vehicle_pf_tracker.trackers.base import BaseTracker
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.image_stream import ImageStream, Turn
from vehicle_pf_tracker.trackers.registry import Variant


class TargetError(InputError):
    """Target that no tracker can start on in the image that it was given for."""


class Session:
    """Control of one variant's tracker: start, steps, restarts.

    Odd images are rejected, or admitted after all, by `ImageStream`; then only the estimate of the
    first one is missing. An image whose stamp proves to have been ahead when the next one comes is
    taken back, as if it had never come. A tracker that fails twice in a row starts anew where it
    last saw the target.

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
    tracker : BaseTracker
        Follows the target.
    refusal : str
        Reason why the last frame's new target was refused while there is a track; else empty.
    """

    def __init__(
        self, variant: Variant, parameters: Any, settings: SessionParameters | None = None
    ) -> None:
        self.variant = variant
        self.settings = settings or SessionParameters()
        self.refusal = ""
        self.tracker: BaseTracker[Any] = variant.tracker(parameters)
        self._stream = ImageStream(parameters.frame_rate, self.settings.reset_on_time_jump)
        self._attempts = Attempts()
        self._backup: BaseTracker[Any] | None = None
        self._pending: Box | None = self.settings.target.box
        self._seen: Box | None = None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height in px that images are expected to have; None for any size."""
        return self._stream.size

    @property
    def events(self) -> list[str]:
        """Irregularities of the last image, for logs and diagnostics."""
        return self._attempts.events

    @property
    def recovered(self) -> bool:
        """True where the tracker failed and started anew in the last image."""
        return self._attempts.recovered

    @property
    def waiting(self) -> bool:
        """True while there is no target to follow."""
        return not self._is_tracking and self._pending is None

    @property
    def _is_tracking(self) -> bool:
        return self._seen is not None

    def set_target(self, box: Box) -> None:
        """Start, or start again, on `box` in the next accepted frame."""
        self._pending = box

    def reset(self) -> None:
        """Go back to the configured target, or to waiting for one, and discard the track."""
        self._stream.reset()
        self._backup = None
        self._seen = None
        self._pending = self.settings.target.box

    def reconfigure(self, parameters: Any, settings: SessionParameters) -> None:
        """Take new parameters between two frames; a changed target starts on it."""
        if settings.target != self.settings.target:
            self._pending = settings.target.box
        self.settings = settings
        self.tracker.reconfigure(parameters)
        self._stream.reconfigure(parameters.frame_rate, settings.reset_on_time_jump)

    def feed(self, image: Frame | CodedImage, stamp_ns: int) -> Estimate | None:
        """Take the next image; None while there is no target.

        Parameters
        ----------
        image : (H, W, 3) array or CodedImage
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
            reported in `events` and `refusal` instead, and the track continues.
        InputError
            If the frame is not usable.
        TrackerError
            If the tracker fails, and does not start anew for it.
        """
        self.refusal = ""
        self._attempts.begin_image()
        estimate = None
        for turn in self._stream.admit(image, stamp_ns, is_tracking=self._is_tracking):
            self.events.extend(turn.events)
            if turn.corrects:
                self._take_back()
            kernels = self.tracker.kernels  # they have no state of their own, and need no copy
            kept = {id(kernels): kernels}
            # Copied only where the stamp may prove to be ahead: a tracker's state is large.
            self._backup = copy.deepcopy(self.tracker, kept) if turn.leaps else None
            # Where it was seen last says nothing in images of another size, or of another time.
            if turn.begins_anew:
                self._seen = None
                self._start_anew()
            # Known after ten intervals; until then it may change from image to image.
            self.tracker.frame_period = turn.period
            estimate = self._attempts.take(partial(self._step, turn), self._start_anew)
        return estimate

    def _start_anew(self) -> None:
        # Where it was seen last, or on the configured target; a box that was just set is newer.
        self._pending = self._pending or self._seen or self.settings.target.box

    def _take_back(self) -> None:
        """Go back to before the last image, whose stamp was ahead, unless it started the target."""
        if self._backup is None:
            return
        parameters = self.tracker.parameters
        self.tracker = self._backup
        # The copy may be older than a change of parameters.
        if self.tracker.parameters != parameters:
            self.tracker.reconfigure(parameters)

    def _step(self, turn: Turn) -> Estimate | None:
        box = self._pending
        if box is not None and self._is_usable(box, frame_size(turn.frame)):
            estimate = self.tracker.start(turn.frame, box)
            self._seen = box
            self._backup = None
            self._pending = None
        elif self._is_tracking:
            estimate = self.tracker.step(turn.frame, turn.elapsed)
        else:
            return None
        # Only where it was seen: a new start on a prediction would learn the occluder.
        if estimate.mode is Mode.TRACKING:
            self._seen = estimate.box
        return estimate

    def _is_usable(self, box: Box, size: tuple[int, int]) -> bool:
        try:
            check_target(box, *size)
        except InputError as error:
            self._pending = None
            if not self._is_tracking:
                configured = self.settings.target.box
                self._pending = configured if configured != box else None
                raise TargetError(str(error)) from None
            self.refusal = str(error)
            self.events.append(f"target refused: {error}")
            return False
        return True
