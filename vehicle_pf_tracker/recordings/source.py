# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Opening of sources of images by their names: recordings, videos, folders, cameras, streams."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal, TypeAlias

from vehicle_pf_tracker.core.errors import InputError, brief
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.footage import Footage
from vehicle_pf_tracker.recordings.opened_footage import open_footage
from vehicle_pf_tracker.recordings.recording_names import is_recording
from vehicle_pf_tracker.recordings.truth.files import Beside

ImageSource: TypeAlias = Recording | Footage
"""A stream of stamped images, with truth where it is known."""


def open_source(
    source: str | Path,
    *,
    topic: str | None = None,
    fps: float | None = None,
    truth: Path | None = None,
    identity: int | None = None,
    beside: Beside | Literal["needed", "noted", "ignored"] = Beside.NEEDED,
) -> ImageSource:
    """Open a recording, a video file, a folder of images, a camera or a stream.

    Parameters
    ----------
    source : str or Path
        Path; index of a camera, as ``0``; or URL, as ``rtsp://...`` or ``https://...``.
    topic : str or None
        The image topic, where a recording has several.
    fps : float or None
        Frame rate of a folder or a video, 1/s; None takes what it states.
    truth : Path or None
        File of the truth of a folder or a video; None takes what lies beside a folder's images.
    identity : int or None
        Number of the target, where the truth has several.
    beside : Beside or str
        Use of the truth beside a folder's images: its faults are errors where it is ``"needed"``,
        and notices where it is ``"noted"``; ``"ignored"``, it is not read.

    Raises
    ------
    InputError
        If there is no such source, or an option does not fit it.
    """
    path = Path(source)
    # Recordings first: a rosbag2 folder is a folder, too, and has no images that could be listed.
    if is_recording(path):
        if fps is not None:
            raise InputError(f"{path} is a recording, whose images have stamps; leave --fps out")
        if truth is not None or identity is not None:
            raise InputError(f"{path} is a recording, with its own truth; leave --truth, --id out")
        return Recording(path, topic)
    try:
        use = Beside(beside)
    except ValueError:
        uses = ", ".join(Beside)
        raise InputError(f"beside must be one of {uses}, not {brief(beside)}") from None
    footage = open_footage(source, truth=truth, fps=fps, identity=identity, beside=use)
    # After it is opened: a source that is not there is the more important sentence.
    if topic is not None:
        raise InputError(f"{source} is not a recording and has no topics; leave --topic out")
    return footage


def frame_at(
    source: ImageSource, number: int, progress: Callable[[int, int], object] = lambda *_: None
) -> Frame:
    """Return frame `number` of a source, from 1; `progress` takes the frames read, and `number`.

    Raises
    ------
    InputError
        If there are fewer frames, or it cannot be read.
    """
    # From the first frame on: videos of most codecs cannot be entered in the middle.
    count = 0
    for count, picture in enumerate(source.frames(), start=1):
        progress(count, number)
        if count == number:
            if picture.frame is None:
                raise InputError(f"frame {number} cannot be read")
            return picture.frame
    raise InputError(f"there is no frame {number}; the source has {count}")
