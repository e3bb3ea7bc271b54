# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Video file in H.264, which browsers play."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.results.output_files import make_folder, replacing

VIDEO_SUFFIX = ".mp4"
"""Ending of a video: the container that browsers play everywhere."""
_TICKS = 90_000
"""Ticks of an H.264 video's clock per second, those of MPEG: whole for every usual frame rate."""
_QUALITY = {"preset": "veryfast", "crf": "23"}
"""x264's own middle quality, with the preset that costs 4 ms for a frame of 640x360 px."""
LOWEST_RATE = 0.1
"""Lowest frame rate that a video is written with, 1/s: a frame for ten seconds, as of a time-lapse.
The encoder refuses rates far below it."""
HIGHEST_RATE = 1000.0
"""Highest frame rate that a video is written with, 1/s, that of a high-speed camera. The encoder
refuses rates far above it."""

Write: TypeAlias = Callable[[Frame, float], None]
"""Function that appends an RGB frame to a video, to be shown from a time of the video on, s."""


def check_video(path: Path) -> None:
    """Check before any work that a video can be written under this name.

    Raises
    ------
    InputError
        If its name ends otherwise than in ``.mp4``.
    ModuleNotFoundError
        If PyAV is not installed: OpenCV's wheels have no encoder that browsers play.
    """
    if path.suffix != VIDEO_SUFFIX:
        raise InputError(f"the video {path} must end in {VIDEO_SUFFIX}")
    importlib.import_module("av")


@contextmanager
def video_writer(path: Path, size: tuple[int, int], rate: float) -> Iterator[Write]:
    """Yield a function that writes a frame; the video appears when it is complete.

    Parameters
    ----------
    path : Path
        The file, ``.mp4``; an existing one is replaced.
    size : (int, int)
        Width and height of the frames in px; odd ones lose their last row or column.
    rate : float
        Usual number of frames per second.

    Raises
    ------
    InputError
        If it cannot be written, or its name ends otherwise.
    ModuleNotFoundError
        If PyAV is not installed.
    """
    check_video(path)
    make_folder(path.parent)
    even = size[0] // 2 * 2, size[1] // 2 * 2
    with replacing(path) as partial, h264_writer(partial, even, rate) as write:
        yield lambda frame, at: write(np.ascontiguousarray(frame[: even[1], : even[0]]), at)


@contextmanager
def h264_writer(path: Path, size: tuple[int, int], rate: float) -> Iterator[Write]:
    """Give a function that appends frames to an H.264 file, which is whole at the end of the block.

    Parameters
    ----------
    path : Path
        The file.
    size : (int, int)
        Width and height of the frames in px, both even.
    rate : float
        Usual number of frames per second.
    """
    import av  # noqa: PLC0415 - an extra

    limited = min(max(rate, LOWEST_RATE), HIGHEST_RATE)
    with av.open(str(path.absolute()), "w") as container:  # 10:00.mp4 is no protocol
        exact = Fraction(limited).limit_denominator(1001)  # 30000/1001 is the oddest in use
        stream: Any = container.add_stream("libx264", rate=exact)
        stream.codec_context.time_base = Fraction(1, _TICKS)
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        stream.options = _QUALITY

        def write(frame: Frame, at: float) -> None:
            picture = av.VideoFrame.from_ndarray(frame, format="rgb24")
            picture.pts = round(at * _TICKS)
            picture.time_base = Fraction(1, _TICKS)
            container.mux(stream.encode(picture))

        yield write
        container.mux(stream.encode())
