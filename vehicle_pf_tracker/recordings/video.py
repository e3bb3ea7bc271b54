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

"""Footage in a video file."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.footage import Picture, check_fps, read_truth_table, stamp_of

# The decoder's own complaints would go to the terminal beside our sentence.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")

_SILENT = 0
"""OpenCV's log level that says nothing; not every version names it."""


class VideoFile:
    """The frames of a video file, at the frame rate that the file states.

    Parameters
    ----------
    path : Path
        The file.
    truth : Path or None
        A table as `truth_table` reads it, frames counted from 1.

    Raises
    ------
    InputError
        If the file is not a video, has no frame or no frame rate, or the truth is invalid.
    """

    def __init__(self, path: Path, truth: Path | None = None) -> None:
        self._path = path
        self._truth = {} if truth is None else read_truth_table(truth)
        self._read = 0
        video = self._open()
        self.fps = float(video.get(cv2.CAP_PROP_FPS))
        stated = video.get(cv2.CAP_PROP_FRAME_COUNT)
        self.total = int(stated) if math.isfinite(stated) and stated > 0 else None
        video.release()
        if not math.isfinite(self.fps) or self.fps <= 0:
            raise InputError(f"the video {path} states no frame rate; convert it to MP4 first")
        check_fps(self.fps, path)

    def pictures(self) -> Iterator[Picture]:
        """Yield the frames, stamped by their index."""
        video = self._open()
        try:
            self._read = 0
            while (frame := _next_frame(video)) is not None:
                stamp, number = stamp_of(self._read, self.fps), self._read + 1
                row = self._truth.get(number)
                truth = None if row is None else Truth(stamp, row.box, row.occlusion)
                yield Picture(stamp, frame, f"frame {number} of {self._path}", truth=truth)
                self._read = number
        finally:
            video.release()
        if not self._read:
            raise InputError(f"no frame of the video {self._path} can be decoded")

    def notices(self) -> list[str]:
        """Report fewer frames than the file states, and truth without a frame."""
        notices = []
        if self.total is not None and self._read < self.total:
            notices.append(
                f"the video {self._path} states {self.total} frames, {self._read} could be read"
            )
        lost = sum(not 1 <= number <= self._read for number in self._truth)
        return notices + ([f"frames of the truth without an image: {lost}"] if lost else [])

    def _open(self) -> cv2.VideoCapture:
        with _quiet():
            video = cv2.VideoCapture(str(self._path), _backend())
        if not video.isOpened():
            raise InputError(f"{self._path} is not a video file that can be decoded")
        return video


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep OpenCV from complaining on the terminal."""
    # OpenCV moved these functions between 4 and 5.
    logging: Any = getattr(cv2.utils, "logging", cv2)
    level = logging.getLogLevel()
    logging.setLogLevel(_SILENT)
    try:
        yield
    finally:
        logging.setLogLevel(level)


def _backend() -> int:
    """Choose FFmpeg where OpenCV has it: the other decoders complain on the terminal."""
    has_ffmpeg = cv2.CAP_FFMPEG in cv2.videoio_registry.getStreamBackends()
    return cv2.CAP_FFMPEG if has_ffmpeg else cv2.CAP_ANY


def _next_frame(video: cv2.VideoCapture) -> Frame | None:
    is_read, image = video.read()
    if not is_read:
        return None
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB)  # type: ignore[return-value]
