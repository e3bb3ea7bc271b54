# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Footage of a video file, at the times that the file states."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.decoders import Decoder, open_decoder
from vehicle_pf_tracker.recordings.footage import (
    LAST_STAMP_NS,
    START_NS,
    Footage,
    Picture,
    check_fps,
    stamp_of,
)
from vehicle_pf_tracker.recordings.truth.files import Table, read_truth
from vehicle_pf_tracker.recordings.truth.labels import Images

_MOST_FRAMES = 1_000_000
"""Frames that truth may name in a video that states no number: nine hours of 30 frames/s."""
_ROUNDING_NS = 1_000_000
"""Largest difference of a stated time from an even rate that is rounding: containers keep ms."""

_WHOLE = 0.95
"""Least share of the stated length that a whole video has. A choice: some decoders count the
frames behind damaged ones as if these had never been, and lengths are rounded."""


class VideoFile(Footage):
    """The frames of a video file, at the times that the file states.

    Where these keep to the frame rate but for rounding, stamps are those of that rate; elsewhere,
    as in videos of a variable frame rate, they are the file's own.

    Parameters
    ----------
    path : Path or str
        The file, or a URL of one.
    truth : Path or None
        File of the truth, as `read_truth` reads it; frames count from 1.
    fps : float or None
        Frame rate, 1/s, that takes the place of all stated times.
    identity : int or None
        Number of the target, where the truth has several.

    Raises
    ------
    InputError
        If the file is not a video, has no frame or no frame rate, or the truth is invalid.
    """

    def __init__(
        self,
        path: Path | str,
        truth: Path | None = None,
        fps: float | None = None,
        identity: int | None = None,
    ) -> None:
        self._path = path
        self._keeps_times = fps is None
        # Opened once for what it states, and anew for each reading.
        with closing(self._open()) as video:
            self.fps = video.fps if fps is None else check_fps(fps, "--fps")
            self.frame_count = video.frame_count
            size = video.size
        if not math.isfinite(self.fps) or self.fps <= 0:
            raise InputError(f"the video {path} states no frame rate; give it with --fps")
        check_fps(self.fps, path)
        # Before decoding nobody knows how many frames there are: truth is checked against the most.
        images = Images(range(1, self._most_frames() + 1), lambda: size, {})
        table: Table = {}
        self._found: list[str] = []
        if truth is not None:
            table, self._found = read_truth([truth], images, identity)
        self._notices = self._found
        # At even stamps until the frames are read.
        self._truth = {
            n: replace(row, stamp_ns=stamp_of(n - 1, self.fps)) for n, row in table.items()
        }

    def frames(self) -> Iterator[Picture]:
        """Yield the frames with their stamps."""
        number = last = untimed = 0
        with closing(self._open()) as video:
            while (read := video.read()) is not None:
                frame, time_ms = read
                stamp = self._stamp(time_ms, number, last)
                if stamp is None:
                    # Stamps have to increase: trackers take a repeated one for a repeated frame.
                    stamp = last + round(1e9 / self.fps) if last else START_NS
                    untimed += 1
                number = number + 1
                last = stamp
                truth = self._truth.get(number)
                if truth is not None:
                    truth = self._truth[number] = replace(truth, stamp_ns=stamp)
                yield Picture(stamp, frame, f"frame {number} of {self._path}", truth=truth)
        if not number:
            raise InputError(f"no frame of the video {self._path} can be decoded")
        irregularities = self._irregularities(number, untimed, last)
        self._notices = [*self._found, *irregularities]

    def truth(self) -> list[Truth]:
        """Return the truth, at even stamps where its frames are not read yet."""
        return [one for number, one in sorted(self._truth.items()) if number >= 1]

    def _most_frames(self) -> int:
        """Return the number of frames that there may be; a number stated may be any."""
        path = Path(self._path)
        size = path.stat().st_size if path.is_file() else _MOST_FRAMES  # a frame has a byte or more
        return max(min(self.frame_count or _MOST_FRAMES, size), 1)

    def _stamp(self, time_ms: float, index: int, last: int) -> int | None:
        """Return the stamp of a frame in ns; None if it has none, or not one after `last`."""
        even = stamp_of(index, self.fps)
        if not self._keeps_times:
            return even
        if not math.isfinite(time_ms):
            return None
        # Even stamps where the stated ones differ by rounding only: intervals are then equal.
        stated = START_NS + round(time_ms * 1e6)
        if abs(stated - even) <= _ROUNDING_NS and even > last:
            return even
        return stated if last < stated <= LAST_STAMP_NS else None

    def _irregularities(self, read: int, untimed: int, last: int) -> Iterator[str]:
        """Report fewer frames than the file states, times that it lacks, truth without a frame."""
        if self.frame_count is not None and read < self.frame_count:
            stated = (
                f"the video {self._path} states {self.frame_count} frames, {read} could be read"
            )
            yield f"{stated}{self._reach(self.frame_count, last)}"
        if untimed:
            frames = "1 frame; it follows" if untimed == 1 else f"{untimed} frames; they follow"
            yield (
                f"the video {self._path} states no time, or none after the frame before, for "
                f"{frames} at {self.fps:g} frames/s"
            )
        if lost := sum(not 1 <= number <= read for number in self._truth):
            yield f"frames of the truth without an image: {lost}"

    def _reach(self, frame_count: int, last: int) -> str:
        """Return how far frames reach that are fewer than stated, by the stamp of the last one."""
        if not self._keeps_times:
            return ""
        # Many containers state no number, but a length: at a variable rate it holds fewer frames.
        length_s = frame_count / self.fps
        end_s = (last - START_NS) * 1e-9 + 1 / self.fps
        if end_s >= _WHOLE * length_s:
            return ", to its end: its frame rate varies, or others are damaged"
        return f"; it ends after {end_s:.1f} of {length_s:.1f} s"

    def _open(self) -> Decoder:
        return open_decoder(self._path)
