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

"""Several targets followed through one pass over a source, drawn as they go."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.offline.contact_sheet import ContactSheet
from vehicle_pf_tracker.offline.drawing import Annotator, annotated
from vehicle_pf_tracker.offline.driver import OfflineTracker
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.offline.estimates_recording import OnFrame
from vehicle_pf_tracker.offline.video_writer import VideoWriter, video_writer
from vehicle_pf_tracker.recordings.reader import StampedFrame

Numbered: TypeAlias = Iterator[tuple[int, StampedFrame]]
Draw: TypeAlias = Callable[[], Frame]

_DEFAULT_RATE = 30.0
"""Frame rate of a video whose stamps state none, 1/s."""
RATE_FRAMES = 30
"""Frames whose stamps give the video's rate: the median of a second forgives a gap."""


class Pictures:
    """Annotated frames: a video, a window, and the key frames.

    Parameters
    ----------
    video : Path or None
        Video to write.
    particles : bool
        Draw the particles.
    show : callable or None
        Called with each annotated frame; False ends the run.

    Attributes
    ----------
    sheet : ContactSheet
        The key frames.
    """

    def __init__(
        self,
        video: Path | None = None,
        *,
        particles: bool = False,
        show: Callable[[Frame], bool] | None = None,
    ) -> None:
        self.video = video
        self.particles = particles
        self.sheet = ContactSheet()
        self._show = show

    @contextmanager
    def drawing(self, rate: float) -> Iterator[Callable[[tuple[str, ...], Draw, Frame], bool]]:
        """Give a function that takes modes, drawing and image of each frame; False ends the run."""
        with ExitStack() as stack:
            video: VideoWriter | None = None

            def take(modes: tuple[str, ...], draw: Draw, frame: Frame) -> bool:
                nonlocal video
                self.sheet.add(modes, draw)
                if self.video is not None and video is None:
                    writing = video_writer(self.video, frame_size(frame), rate)
                    video = stack.enter_context(writing)
                if video is not None:
                    video.write(draw())
                return self._show is None or self._show(draw())

            yield take


def follow(
    trackers: Mapping[str, OfflineTracker],
    frames: Numbered,
    pictures: Pictures,
    on_frame: OnFrame | None = None,
) -> dict[str, list[EstimateRow]]:
    """Track every target through the same frames, each decoded once.

    Parameters
    ----------
    trackers : mapping of str to OfflineTracker
        By the names of their targets.
    frames : iterator of (int, StampedFrame)
        Frames with their numbers, which follow each other.
    pictures : Pictures
        Pictures to make meanwhile.
    on_frame : callable or None
        Takes each frame with its rows.

    Returns
    -------
    dict of str to list of EstimateRow
        The rows of each target.

    Raises
    ------
    InputError
        If a target is invalid in its frame, or the video cannot be written.
    """
    # The rate is that of the first second, so this much is read ahead of the video.
    ahead = list(itertools.islice(frames, RATE_FRAMES if pictures.video else 1))
    rows: dict[str, list[EstimateRow]] = {name: [] for name in trackers}
    if not ahead:
        return rows
    first, start_ns = ahead[0][0], ahead[0][1].stamp_ns
    shown, *streams = itertools.tee(itertools.chain(ahead, frames), 1 + len(trackers))
    runs = [
        tracker.rows(((found.stamp_ns, found.frame) for _, found in stream), first)
        for tracker, stream in zip(trackers.values(), streams, strict=True)
    ]
    annotators = [
        Annotator(name if len(trackers) > 1 else "", particles=pictures.particles)
        for name in trackers
    ]
    with pictures.drawing(frame_rate_of(ahead)) as take:
        for (_, found), *of_frame in zip(shown, *runs, strict=True):
            for name, row in zip(trackers, of_frame, strict=True):
                rows[name].append(row)
            if on_frame is not None:
                on_frame(found, dict(zip(trackers, of_frame, strict=True)))
            estimates = [tracker.estimate for tracker in trackers.values()]
            for annotator, estimate in zip(annotators, estimates, strict=True):
                annotator.follow(estimate)
            if found.frame is None:
                continue
            states = list(zip(annotators, of_frame, estimates, strict=True))
            draw = partial(annotated, found.frame, found.stamp_ns - start_ns, states)
            if not take(tuple(row.mode for row in of_frame), draw, found.frame):
                break
    return rows


def frame_rate_of(frames: list[tuple[int, StampedFrame]]) -> float:
    """Return the frame rate of `frames` by their stamps, 1/s."""
    stamps = [found.stamp_ns for _, found in frames]
    gaps = sorted(later - earlier for earlier, later in itertools.pairwise(stamps))
    usual = gaps[len(gaps) // 2] if gaps else 0
    return 1e9 / usual if usual > 0 else _DEFAULT_RATE
