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

"""Footage by its name: a video file, a folder of images, a camera or a stream."""

from __future__ import annotations

from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.footage import Footage
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.video import Camera, VideoFile

_CONVERSION = "rosbags-convert --src {path} --dst converted --dst-storage mcap"


def open_footage(source: str | Path, *, fps: float | None = None) -> Footage:
    """Open a video file, a folder of images, a camera or a stream.

    Parameters
    ----------
    source : str or Path
        Path; index of a camera, as ``0``; or URL, as ``rtsp://...`` or ``https://...``.
    fps : float or None
        Frame rate of a folder or a video, 1/s; None takes what it states.

    Raises
    ------
    InputError
        If there is no such source, or it is a bag.
    """
    text = str(source)
    if text.isdecimal() and not Path(text).exists():
        return Camera(int(text))
    if "://" in text:
        camera = Camera(text)
        return camera if camera.is_endless else VideoFile(text, fps=fps)
    path = Path(text)
    refuse_other_bags(path)
    if not path.exists():
        raise InputError(f"there is no file or folder {path}")
    if path.is_dir():
        return FrameFolder(path, fps)
    if not path.is_file():
        raise InputError(f"{path} is not a regular file or a folder")
    return VideoFile(path, fps=fps)


def is_live(footage: Footage) -> bool:
    """Return whether the images come by themselves: those of a camera or a stream."""
    return isinstance(footage, Camera)


def is_recording(path: Path) -> bool:
    """Return whether `path` is a rosbag2 folder or an MCAP file, by its name and content."""
    return path.suffix == ".mcap" or (path / "metadata.yaml").exists()


def refuse_other_bags(path: Path) -> None:
    """Raise for a bag of ROS 1 or of SQLite, with the command that converts it.

    Raises
    ------
    InputError
        If it is one.
    """
    kinds = {".bag": "a ROS 1 bag", ".db3": "a bag in SQLite"}
    if path.suffix in kinds:
        folder = path.parent if path.suffix == ".db3" else path
        raise InputError(
            f"{path} is {kinds[path.suffix]}; convert it to MCAP: {_CONVERSION.format(path=folder)}"
        )
