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

"""The recordings of an evaluation: paths and URLs, their content, and their decoded frames."""

from __future__ import annotations

import atexit
import functools
import hashlib
import shutil
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any, TypeVar, cast

from vehicle_pf_tracker.core.clock import associate
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source, safe_name
from vehicle_pf_tracker.recordings.bag_folder import recording_files
from vehicle_pf_tracker.recordings.reader import Recording

_MAKE = "make a recording of it first: `vehicle-pf-tracker import {} OUT`"
T = TypeVar("T")
_VIDEOS = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".webm"})


def is_url(location: str) -> bool:
    """Return whether `location` is a URL rather than a path."""
    return "://" in location


def find_recordings(locations: Sequence[str]) -> list[str]:
    """Return the recordings that `locations` name, with folders of recordings spread out.

    Raises
    ------
    InputError
        If one names none, or something that has to be imported first.
    """
    found = [
        recording
        for location in locations
        for recording in (_at_url(location) if is_url(location) else _at_path(Path(location)))
    ]
    return list(dict.fromkeys(found))


def local_copy(location: str) -> Path:
    """Return a local path of the recording; what a URL names is copied, once per process.

    Raises
    ------
    InputError
        If it cannot be fetched.
    """
    return _fetched(location) if is_url(location) else Path(location)


def _at_path(path: Path) -> list[str]:
    if not path.exists():
        raise InputError(f"there is no recording {path}")
    if _is_recording(path):
        return [str(path)]
    if path.is_file() and path.suffix.lower() in _VIDEOS:
        raise InputError(f"{path} is a video; {_MAKE.format(path)}")
    if path.is_file():
        raise InputError(f"{path} is not a recording: give a rosbag2 folder or an MCAP file")
    if (path / "img").is_dir():
        raise InputError(f"{path} is a frame folder; {_MAKE.format(path)}")
    inside = sorted(child for child in path.iterdir() if _is_recording(child))
    if not inside:
        raise InputError(f"the folder {path} is not a recording and holds none")
    return [str(child) for child in inside]


def _is_recording(path: Path) -> bool:
    return _holds_recording(path.iterdir()) if path.is_dir() else path.suffix == ".mcap"


def _holds_recording(children: Iterable[str | Path]) -> bool:
    return any(str(child).endswith((".mcap", "/metadata.yaml")) for child in children)


def _at_url(url: str) -> list[str]:
    system, path = _file_system(url)

    def children(folder: str) -> list[str]:
        return sorted(system.ls(folder, detail=False)) if system.isdir(folder) else []

    def look() -> list[str]:
        if not system.exists(path):
            raise InputError(f"there is no recording {url}")
        if not system.isdir(path) or _holds_recording(children(path)):
            return [path]
        return [child for child in children(path)
                if child.endswith(".mcap") or _holds_recording(children(child))]  # fmt: skip

    found = _asked(url, look)
    if not found:
        raise InputError(f"the folder {url} is not a recording and holds none")
    return [str(system.unstrip_protocol(name)) for name in found]


@functools.cache
def _fetched(url: str) -> Path:
    system, path = _file_system(url)
    name = path.rstrip("/").rsplit("/", 1)[-1]
    target = Path(tempfile.mkdtemp(prefix="vehicle-pf-tracker-")) / name
    atexit.register(shutil.rmtree, target.parent, ignore_errors=True)

    def fetch() -> Path:
        if not system.isdir(path):
            system.get_file(path, str(target))
            return target
        target.mkdir()
        for child in system.ls(path, detail=False):
            if child.endswith((".mcap", "metadata.yaml")):
                system.get_file(child, str(target / child.rsplit("/", 1)[-1]))
        return target

    return _asked(url, fetch)


def _file_system(url: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs  # noqa: PLC0415 - an extra
    except ModuleNotFoundError:
        raise InputError(
            f"the recording {url} is a URL, and to read those the extra [cluster] is needed: "
            "`pip install 'vehicle_pf_tracker[cluster]'`"
        ) from None
    return _asked(url, lambda: cast("tuple[Any, str]", url_to_fs(url)))


def _asked(url: str, question: Callable[[], T]) -> T:
    """Ask the file system; it may be of any kind, and fail in any way."""
    try:
        return question()
    except InputError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"cannot read the recording {url}: {reason}") from error


FRAMES_BYTES = 1 << 30
"""Largest recording, in bytes of frames, that is decoded once: 1 GiB, a share of a small machine
that leaves room for a worker per core. Larger ones are decoded for each run."""
_BLOCK = 1 << 22


class Footage:
    """A local recording: its truth, and its frames, readable repeatedly.

    Attributes
    ----------
    truth : tuple of Truth
        True states of the vehicle, in order.
    """

    def __init__(self, source: Source) -> None:
        path = local_copy(source.path)
        if _digest(path) != source.digest:
            raise InputError(f"the recording {source.path} has changed since it was planned")
        self._recording = Recording(path, source.topic)
        self.truth: tuple[Truth, ...] = self._recording.truth()
        size = source.frames * source.width * source.height * 3
        self._kept = list(self._decoded()) if size <= FRAMES_BYTES else None

    @property
    def notices(self) -> list[str]:
        """Irregularities of the recording, a sentence each."""
        return self._recording.notices

    def frames(self) -> Iterator[tuple[int, Frame | None]]:
        """Give the stamp (ns) and the frame of each image, in order."""
        return self._decoded() if self._kept is None else iter(self._kept)

    def _decoded(self) -> Iterator[tuple[int, Frame | None]]:
        return ((image.stamp_ns, image.frame) for image in self._recording.frames())


class Shelf:
    """Keeps the footage that was used last, for all threads of this process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._held: tuple[Source, Footage] | None = None

    def footage(self, source: Source) -> Footage:
        """Return the footage of `source`; that of another one is discarded."""
        with self._lock:
            if self._held is None or self._held[0] != source:
                self._held = None  # so that two are never in memory
                self._held = source, Footage(source)
            return self._held[1]


SHELF = Shelf()


def footage(source: Source) -> Footage:
    """Return the footage of `source`, decoded once while it is asked for in a row.

    Raises
    ------
    InputError
        If it cannot be read, or is not what was planned with.
    """
    return SHELF.footage(source)


def describe(
    locations: Sequence[str],
    topic: str | None,
    max_diff: float,
    on_stage: Callable[[str], object] = lambda _: None,
) -> list[tuple[Source, dict[int, Truth]]]:
    """Describe recordings, and read their truth by the number of its frame.

    `on_stage` takes a few words before each.

    Raises
    ------
    InputError
        If one cannot be read or has no truth, or two have one name.
    """
    names = _names(locations)
    described = []
    for location in locations:
        on_stage(f"reading {location}")
        described.append(_describe(location, names[location], topic, max_diff))
    return described


def _describe(
    location: str, name: str, topic: str | None, max_diff: float
) -> tuple[Source, dict[int, Truth]]:
    path = local_copy(location)
    recording = Recording(path, topic)
    truth = recording.truth()
    if not truth:
        raise InputError(
            f"the recording {location} has no truth to compare with; "
            "import it with truth, or track it with `vehicle-pf-tracker run`"
        )
    stamps = [
        message.log_time_ns if message.stamp_ns is None else message.stamp_ns
        for message in recording.messages({recording.image_topic})
    ]
    pairs = associate(stamps, [one.stamp_ns for one in truth], max_diff)
    if not pairs:
        raise InputError(
            f"no stamp of the truth in {location} is within {max_diff:g} s of an image's; "
            "a larger --max-diff may help"
        )
    width, height = _size(recording)
    digest = _digest(path)
    found = location if is_url(location) else str(Path(location).absolute())
    source = Source(name, found, recording.image_topic, len(stamps), width, height, digest)
    return source, {index + 1: truth[place] for index, place in pairs.items()}


def _size(recording: Recording) -> tuple[int, int]:
    frames = (image.frame for image in recording.frames())
    first = next((frame for frame in frames if frame is not None), None)
    if first is None:
        raise InputError(f"the recording {recording.path} has no image that can be read")
    return frame_size(first)


def _digest(path: Path) -> str:
    """Digest the names and the bytes of the files of a recording."""
    digest = hashlib.sha256()
    for file in recording_files(path)[0]:
        digest.update(file.name.encode() + b"\0")
        with file.open("rb") as stream:
            while block := stream.read(_BLOCK):
                digest.update(block)
    return digest.hexdigest()


def _names(locations: Sequence[str]) -> Mapping[str, str]:
    """Name recordings by their last part, or their last two where those are not distinct."""
    for parts in (1, 2):
        names = {location: _name(location, parts) for location in locations}
        if len(set(names.values())) == len(names):
            return names
    twice = next(name for name in names.values() if list(names.values()).count(name) > 1)
    raise InputError(f"several recordings would be called {twice}; rename a folder")


def _name(location: str, parts: int) -> str:
    path = PurePosixPath(location if is_url(location) else Path(location).absolute().as_posix())
    words = [*path.parts[-parts:-1], path.name.removesuffix(".mcap")]
    return safe_name("-".join(words))
