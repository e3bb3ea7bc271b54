# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Opening of footage of any kind by its name, without the readers of recordings."""

from __future__ import annotations

from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.footage import Footage
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.live_camera import LiveCamera
from vehicle_pf_tracker.recordings.recording_names import CONVERSION, is_url
from vehicle_pf_tracker.recordings.truth.files import Beside
from vehicle_pf_tracker.recordings.video import VideoFile


def open_footage(
    source: str | Path,
    *,
    truth: Path | None = None,
    fps: float | None = None,
    identity: int | None = None,
    beside: Beside = Beside.NEEDED,
) -> Footage:
    """Open a video file, a folder of images, a camera or a stream.

    Parameters
    ----------
    source : str or Path
        Path; index of a camera, as ``0``; or URL, as ``rtsp://...`` or ``https://...``.
    truth : Path or None
        File of the truth, as `read_truth` reads it; None takes what lies beside a folder's images.
    fps : float or None
        Frame rate of a folder or a video, 1/s; None takes what it states.
    identity : int or None
        Number of the target, where the truth has several.
    beside : Beside
        Use of the truth beside a folder's images.

    Raises
    ------
    InputError
        If there is no such source, it is a bag, or a truth is given for a live source.
    """
    text = str(source)
    # A file that is called 0 is a file.
    is_index = text.isdecimal() and not Path(text).exists()
    if is_index or is_url(text):
        # A URL may be a live stream or a file: that is known once it is open.
        camera = LiveCamera(int(text) if is_index else text)
        if not is_index and not camera.is_endless:
            return VideoFile(text, truth, fps, identity)
        if truth is not None:
            raise InputError(f"{source} is live and has no truth; leave --truth out")
        return camera
    path = Path(text)
    if path.suffix == ".bag":
        raise InputError(
            f"{path} is a ROS 1 bag; convert it to MCAP: {CONVERSION.format(path=path)}"
        )
    if not path.exists():
        raise InputError(f"there is no file or folder {path}")
    if path.is_dir():
        return FrameFolder(path, fps, truth, identity, beside)
    if not path.is_file():
        raise InputError(f"{path} is not a regular file or a folder")
    return VideoFile(path, truth, fps, identity)
