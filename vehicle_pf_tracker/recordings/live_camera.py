# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames of a camera or a network stream, stamped by the clock as they arrive."""

from __future__ import annotations

import time
from collections.abc import Iterator

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.recordings.decoders import OpenCVDecoder, quiet_opencv
from vehicle_pf_tracker.recordings.footage import Footage, Picture


class LiveCamera(Footage):
    """Frames of a camera or a network stream, stamped by the clock as they arrive.

    Parameters
    ----------
    source : int or str
        Index of a camera, or URL of a stream.

    Raises
    ------
    InputError
        If it cannot be opened.
    """

    def __init__(self, source: int | str) -> None:
        self._name = f"the camera {source}" if isinstance(source, int) else f"the stream {source}"
        try:
            self._video = OpenCVDecoder(source)
        except InputError as error:
            raise InputError(f"{self._name} {error}") from None
        self.fps = self._video.fps
        self.frame_count = None
        self._read = 0

    @property
    def is_endless(self) -> bool:
        """True for a live source; False where the URL is that of a video file."""
        return self._video.frame_count is None

    def frames(self) -> Iterator[Picture]:
        """Yield frames until the source ends."""
        # The smallest stamp: the first frame takes the clock's.
        last = 0
        try:
            while (frame := self._next()) is not None:
                self._read += 1
                # A clock that is set back must not send stamps back: one ns more than the last.
                last = max(time.time_ns(), last + 1)
                yield Picture(last, frame, f"frame {self._read} of {self._name}")
        finally:
            self._video.close()
        if not self._read:
            raise InputError(f"{self._name} sends no images")
        self._notices = [f"{self._name} sent no more images after {self._read}"]

    def _next(self) -> Frame | None:
        with quiet_opencv():  # it complains of a stream that stalls
            read = self._video.read()
        return None if read is None else read[0]
