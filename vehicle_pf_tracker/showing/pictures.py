# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a run while it goes on: a video, the sheet of its key frames, and the live page."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, nullcontext
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.showing.contact_sheet import ContactSheet
from vehicle_pf_tracker.showing.live_page import PAGE_NAME, LivePage
from vehicle_pf_tracker.showing.side_products import SideProducts
from vehicle_pf_tracker.showing.video_file import (
    HIGHEST_RATE,
    LOWEST_RATE,
    Write,
    check_video,
    video_writer,
)

Draw: TypeAlias = Callable[[], Frame]
Take: TypeAlias = Callable[[tuple[str, ...], Draw, Frame, int], None]
"""Function of a frame: the mode of each target, what draws it, the image, and the stamp in ns."""
Numbered: TypeAlias = Iterator[tuple[int, StampedFrame]]
"""Frames with their numbers in the source."""

_LONGEST_GAP = 10.0
"""Longest time that a frame is shown, s: stamps that leap do not make a video of hours."""
_DEFAULT_RATE = 30.0
"""Frame rate of a video whose stamps state none, 1/s, the most usual of cameras."""
_RATE_FRAMES = 30
"""Frames whose stamps give the video's rate: the median of a second forgives a gap."""


class Pictures:
    """Annotated frames: a video, the key frames, and the picture of the page.

    Parameters
    ----------
    video : Path or None
        Video to write.
    particles : bool
        Draw the particles.
    sheet : Path or None
        Picture of the key frames to write.

    Attributes
    ----------
    side : SideProducts
        Record of what a run shows that could not be made.

    Raises
    ------
    InputError
        If the name of the video ends otherwise than in ``.mp4``.
    ModuleNotFoundError
        If PyAV, which writes it, is not installed.
    """

    def __init__(
        self, video: Path | None = None, *, particles: bool = False, sheet: Path | None = None
    ) -> None:
        if video is not None:
            check_video(video)
        self.video = video
        self.particles = particles
        self.side = SideProducts()
        self._sheet_path = sheet
        self._sheet = ContactSheet()

    @property
    def has_video(self) -> bool:
        """True where a video was asked for and has not failed."""
        return self.video is not None and not self.side.failed(f"the video {self.video}")

    @contextmanager
    def drawing(self, frames: Numbered) -> Iterator[tuple[Take, Numbered]]:
        """Yield a function that takes each of the `frames`, and these again.

        A video or a sheet that fails is one of the `side` products, and is not left.
        """
        # The video's rate is that of the first second, so this much is read ahead of it.
        ahead = list(itertools.islice(frames, _RATE_FRAMES if self.video else 0))
        rate = _frame_rate([stamped.stamp_ns for _, stamped in ahead])
        film = _film(self.video, rate) if self.video else nullcontext(_nothing)
        with self.side.growing(f"the video {self.video}", film) as add:

            def take(modes: tuple[str, ...], draw: Draw, frame: Frame, stamp_ns: int) -> None:
                if self._sheet_path is not None:
                    with self.side.attempt(f"the picture {self._sheet_path}"):
                        self._sheet.add(modes, draw)
                add(draw, frame_size(frame), stamp_ns)

            yield take, itertools.chain(ahead, frames)

    def show(
        self, page: LivePage | None, draw: Draw, facts: Callable[[], Mapping[str, object]]
    ) -> None:
        """Show the next frame and its numbers on a live page, where there is one that works."""
        if page is not None and not self.side.failed(PAGE_NAME):
            with self.side.attempt(PAGE_NAME):
                page.show(draw, facts)

    def write_sheet(self) -> None:
        """Write the picture of the key frames, where it was asked for and there was a frame."""
        if self._sheet_path is not None:
            with self.side.attempt(f"the picture {self._sheet_path}"):
                self._sheet_path.unlink(missing_ok=True)
                self._sheet.write(self._sheet_path)


def _nothing(*_: object) -> None:
    """Add to no video."""


@contextmanager
def _film(path: Path, rate: float) -> Iterator[Callable[[Draw, tuple[int, int], int], None]]:
    """Yield a function that appends a frame to a video, shown as long as the stamps say.

    It takes the drawing, the size of the first frame in px, and the stamp in ns. `rate` is the
    usual number of frames per second.
    """
    with ExitStack() as stack:
        write: Write | None = None
        at = 0.0
        last_ns = 0

        def add(draw: Draw, size: tuple[int, int], stamp_ns: int) -> None:
            nonlocal write, at, last_ns
            if write is None:
                write = stack.enter_context(video_writer(path, size, rate))
            else:
                gap = (stamp_ns - last_ns) / 1e9
                at += gap if 1 / HIGHEST_RATE <= gap <= _LONGEST_GAP else 1 / rate
            last_ns = stamp_ns
            write(draw(), at)

        yield add


def _frame_rate(stamps: list[int]) -> float:
    """Return the usual frame rate of stamps in ns, 1/s, where a video can have it."""
    gaps = sorted(later - earlier for earlier, later in itertools.pairwise(stamps))
    usual = gaps[len(gaps) // 2] if gaps else 0
    return min(max(1e9 / usual, LOWEST_RATE), HIGHEST_RATE) if usual > 0 else _DEFAULT_RATE
