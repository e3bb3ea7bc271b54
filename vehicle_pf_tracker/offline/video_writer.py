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

"""Video files that browsers play, written frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from importlib import util
from pathlib import Path
from typing import Any, Protocol

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.output_files import make_folder, replacing
from vehicle_pf_tracker.recordings.video import quiet_opencv

SUFFIX = ".mp4"
NO_ENCODER = (
    "this video is MPEG-4 Part 2, which browsers do not play; for H.264 install the extra [video], "
    "pip install 'vehicle_pf_tracker[video]'"
)
_QUALITY = {"preset": "veryfast", "crf": "23"}
"""x264's own middle quality, with the preset that costs 4 ms for a frame of 640x360 px."""


class VideoWriter(Protocol):
    """Takes RGB frames of one size."""

    def write(self, frame: Frame) -> None:
        """Append a frame."""

    def close(self) -> None:
        """Complete the file."""

    def is_complete(self) -> bool:
        """Return whether the closed file has every frame."""


@contextmanager
def video_writer(path: Path, size: tuple[int, int], rate: float) -> Iterator[VideoWriter]:
    """Open a video for writing; it appears under its name when it is complete.

    It is H.264 where PyAV is installed, else MPEG-4 Part 2 by OpenCV.

    Parameters
    ----------
    path : Path
        The file, ``.mp4``; an existing one is replaced.
    size : (int, int)
        Width and height of the frames in px; odd ones lose their last row or column.
    rate : float
        Frames per second.

    Raises
    ------
    InputError
        If it cannot be written, or its name ends otherwise.
    """
    if path.suffix != SUFFIX:
        raise InputError(f"the video {path} must end in {SUFFIX}")
    make_folder(path.parent)
    even = size[0] // 2 * 2, size[1] // 2 * 2
    with replacing(path) as partial:
        kind = _H264Video if has_encoder() else _OpenCvVideo
        writer: VideoWriter = kind(partial, even, rate)
        try:
            yield writer
        finally:
            writer.close()
        if not writer.is_complete():
            raise InputError(f"cannot write {path}: frames are missing; is the disk full?")


def has_encoder() -> bool:
    """Return whether videos will be ones that browsers play."""
    return util.find_spec("av") is not None


class _OpenCvVideo:
    def __init__(self, path: Path, size: tuple[int, int], rate: float) -> None:
        self._size, self._path, self._count = size, path, 0
        self._writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), rate, size)
        if not self._writer.isOpened():
            raise InputError("this OpenCV cannot write mp4v videos")

    def write(self, frame: Frame) -> None:
        self._count += 1
        with quiet_opencv():
            self._writer.write(cv2.cvtColor(_cropped(frame, self._size), cv2.COLOR_RGB2BGR))

    def close(self) -> None:
        with quiet_opencv():
            self._writer.release()

    def is_complete(self) -> bool:
        with quiet_opencv():  # its writer reports no failure, as that of a full disk
            found = cv2.VideoCapture(str(self._path)).get(cv2.CAP_PROP_FRAME_COUNT)
        return int(found) == self._count


class _H264Video:
    def __init__(self, path: Path, size: tuple[int, int], rate: float) -> None:
        import av  # noqa: PLC0415 - an extra

        self._size, self._frame_of = size, av.VideoFrame.from_ndarray
        self._container: Any = av.open(str(path), "w")
        exact = Fraction(rate).limit_denominator(1001)  # 30000/1001 is the oddest in use
        self._stream = self._container.add_stream("libx264", rate=exact)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt, self._stream.options = "yuv420p", _QUALITY

    def write(self, frame: Frame) -> None:
        picture = self._frame_of(_cropped(frame, self._size), format="rgb24")
        self._container.mux(self._stream.encode(picture))

    def close(self) -> None:
        self._container.mux(self._stream.encode())
        self._container.close()

    def is_complete(self) -> bool:
        return True  # PyAV raises an error for each failure


def _cropped(frame: Frame, size: tuple[int, int]) -> Frame:
    cropped: Frame = np.ascontiguousarray(frame[: size[1], : size[0]])
    return cropped
