# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a run: a video that browsers play, and a sheet of its key frames."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.results.output_files import make_folder, replacing, write_picture

Draw: TypeAlias = Callable[[], Frame]
Take: TypeAlias = Callable[[tuple[str, ...], Draw, Frame, int], None]
"""Takes the modes, the drawing, the image and the stamp in ns of a frame."""

SUFFIX = ".mp4"
_TICKS = 90_000
"""Ticks of an H.264 video's clock per second, those of MPEG: whole for every usual frame rate."""
_LONGEST_GAP = 10.0
"""Longest time that a frame is shown, s: stamps that leap do not make a video of hours."""
_QUALITY = {"preset": "veryfast", "crf": "23"}
"""x264's own middle quality, with the preset that costs 4 ms for a frame of 640x360 px."""


_DEFAULT_RATE = 30.0
"""Frame rate of a video whose stamps state none, 1/s."""
_RATE_FRAMES = 30
"""Frames whose stamps give the video's rate: the median of a second forgives a gap."""

Numbered: TypeAlias = Iterator[tuple[int, StampedFrame]]
"""Frames with their numbers in the source."""
Write: TypeAlias = Callable[[Frame, float], None]
"""Appends an RGB frame to a video, which is shown from a time after the beginning on, s."""


@contextmanager
def video_writer(path: Path, size: tuple[int, int], rate: float) -> Iterator[Write]:
    """Give a function that writes a frame; the video appears when it is complete.

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
        If PyAV is not installed: OpenCV's wheels have no encoder that browsers play.
    """
    if path.suffix != SUFFIX:
        raise InputError(f"the video {path} must end in {SUFFIX}")
    make_folder(path.parent)
    even = size[0] // 2 * 2, size[1] // 2 * 2
    with replacing(path) as partial, _h264(partial, even, rate) as write:
        yield lambda frame, at: write(np.ascontiguousarray(frame[: even[1], : even[0]]), at)


@contextmanager
def _h264(path: Path, size: tuple[int, int], rate: float) -> Iterator[Write]:
    import av  # noqa: PLC0415 - an extra

    with av.open(str(path), "w") as container:
        exact = Fraction(rate).limit_denominator(1001)  # 30000/1001 is the oddest in use
        stream: Any = container.add_stream("libx264", rate=exact)
        stream.codec_context.time_base = Fraction(1, _TICKS)
        stream.width, stream.height = size
        stream.pix_fmt, stream.options = "yuv420p", _QUALITY

        def write(frame: Frame, at: float) -> None:
            picture = av.VideoFrame.from_ndarray(frame, format="rgb24")
            picture.pts, picture.time_base = round(at * _TICKS), Fraction(1, _TICKS)
            container.mux(stream.encode(picture))

        yield write
        container.mux(stream.encode())


def has_display() -> bool:
    """Return whether windows can be shown."""
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


THUMB_WIDTH = 400
"""Width of a key frame on the sheet, px: three of them fill a page's width."""
_COLUMNS = 3
_MOST = 12
"""Key frames on a sheet: four rows."""
_KEPT = 200
"""Key frames kept in memory, 50 MB of them, of which the sheet shows an even choice."""


class ContactSheet:
    """Keeps the first and the last frame, and those in which a mode changes."""

    def __init__(self) -> None:
        self._kept: list[Frame] = []
        self._last: Callable[[], Frame] | None = None
        self._modes: tuple[str, ...] | None = None

    def add(self, modes: tuple[str, ...], draw: Callable[[], Frame]) -> None:
        """Take the next frame: the mode of each target, and a function that draws it.

        Before and after a change both frames are kept: an occlusion's way in and its way out.
        """
        changes = modes != self._modes
        if changes and len(self._kept) < _KEPT:
            if self._modes is not None and self._last is not None:
                self._kept.append(_thumb(self._last()))
            self._kept.append(_thumb(draw()))
            self._last = None
        else:
            self._last = draw
        self._modes = modes

    def write(self, path: Path) -> None:
        """Write the sheet, where there was a frame.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        thumbs = [*self._kept, *([] if self._last is None else [_thumb(self._last())])]
        if not thumbs:
            return
        chosen = np.unique(np.linspace(0, len(thumbs) - 1, min(len(thumbs), _MOST)).round())
        shown = [thumbs[int(index)] for index in chosen]
        height, columns = max(thumb.shape[0] for thumb in shown), min(_COLUMNS, len(shown))
        rows = -(-len(shown) // columns)
        sheet: Frame = np.full((rows * height, columns * THUMB_WIDTH, 3), 24, np.uint8)
        for index, thumb in enumerate(shown):
            top, left = index // columns * height, index % columns * THUMB_WIDTH
            sheet[top : top + thumb.shape[0], left : left + THUMB_WIDTH] = thumb
        write_picture(path, sheet)


def _thumb(picture: Frame) -> Frame:
    height = max(1, round(THUMB_WIDTH * picture.shape[0] / picture.shape[1]))
    thumb: Frame = cv2.resize(picture, (THUMB_WIDTH, height), interpolation=cv2.INTER_AREA)  # type: ignore[assignment]
    return thumb


class Pictures:
    """Annotated frames: a video, and the key frames.

    Parameters
    ----------
    video : Path or None
        Video to write.
    particles : bool
        Draw the particles.

    Attributes
    ----------
    sheet : ContactSheet
        The key frames.
    problem : str
        Reason why there is no video though one was asked for, as a full disk; else empty.
    """

    def __init__(self, video: Path | None = None, *, particles: bool = False) -> None:
        self.video = video
        self.particles = particles
        self.sheet = ContactSheet()
        self.problem = ""

    @property
    def notices(self) -> list[str]:
        """Shortcomings of the video, a sentence each."""
        return [f"{self.problem}; all else is written"] if self.problem else []

    @contextmanager
    def drawing(self, frames: Numbered) -> Iterator[tuple[Take, Numbered]]:
        """Give a function that takes each of the `frames`, and these again.

        A video that breaks off is removed, and is the run's `problem`: it costs no estimate.
        """
        # The video's rate is that of the first second, so this much is read ahead of it.
        ahead = list(itertools.islice(frames, _RATE_FRAMES if self.video else 0))
        rate = _frame_rate([found.stamp_ns for _, found in ahead])
        with ExitStack() as stack:
            write: Write | None = None
            at, last_ns = 0.0, 0

            def take(modes: tuple[str, ...], draw: Draw, frame: Frame, stamp_ns: int) -> None:
                nonlocal write, at, last_ns
                self.sheet.add(modes, draw)
                if self.video is None or self.problem:
                    return
                if write is None:
                    writing = video_writer(self.video, frame_size(frame), rate)
                    write = stack.enter_context(writing)
                else:
                    gap = (stamp_ns - last_ns) / 1e9
                    at += gap if 0 < gap <= _LONGEST_GAP else 1 / rate
                last_ns = stamp_ns
                picture = draw()
                try:
                    write(picture, at)
                except OSError as error:
                    with self._noting():
                        stack.__exit__(type(error), error, None)

            yield take, itertools.chain(ahead, frames)
            with self._noting():
                stack.pop_all().close()

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Note why the video cannot be written."""
        try:
            yield
        except InputError as error:
            self.problem = str(error)


def _frame_rate(stamps: list[int]) -> float:
    """Return the usual frame rate of stamps in ns, 1/s."""
    gaps = sorted(later - earlier for earlier, later in itertools.pairwise(stamps))
    usual = gaps[len(gaps) // 2] if gaps else 0
    return 1e9 / usual if usual > 0 else _DEFAULT_RATE
