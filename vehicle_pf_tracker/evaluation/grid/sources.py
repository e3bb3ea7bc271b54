"""The recordings of an evaluation, and the one that is being worked on, decoded once."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.association import associate
from vehicle_pf_tracker.evaluation.evaluation_folder import safe_name
from vehicle_pf_tracker.evaluation.grid.locations import at_hand, is_url
from vehicle_pf_tracker.evaluation.source import Source
from vehicle_pf_tracker.recordings.bag_folder import recording_files
from vehicle_pf_tracker.recordings.reader import Recording

FRAMES_BYTES = 1 << 30
"""Decoded frames that a process keeps at most; what is larger is decoded anew for each run."""
_BLOCK = 1 << 22


class Footage:
    """A recording at hand: its truth, and its frames as often as they are wanted.

    Attributes
    ----------
    truth : tuple of Truth
        In order.
    """

    def __init__(self, source: Source) -> None:
        path = at_hand(source.path)
        if _digest(path) != source.digest:
            raise InputError(f"the recording {source.path} is another one than when it was planned")
        self._recording = Recording(path, source.topic)
        self.truth: tuple[Truth, ...] = self._recording.truth()
        size = source.frames * source.width * source.height * 3
        self._kept = list(self._decoded()) if size <= FRAMES_BYTES else None

    @property
    def notices(self) -> list[str]:
        """What is not as it should be in the recording, a sentence each."""
        return self._recording.notices

    def frames(self) -> Iterator[tuple[int, Frame | None]]:
        """Give the stamp (ns) and the frame of each image, in order."""
        return self._decoded() if self._kept is None else iter(self._kept)

    def _decoded(self) -> Iterator[tuple[int, Frame | None]]:
        return ((image.stamp_ns, image.frame) for image in self._recording.frames())


class _Shelf:
    """Keeps the footage that was used last, for all threads of this process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._held: tuple[Source, Footage] | None = None

    def footage(self, source: Source) -> Footage:
        with self._lock:
            if self._held is None or self._held[0] != source:
                self._held = None  # so that two are never in memory
                self._held = source, Footage(source)
            return self._held[1]


_SHELF = _Shelf()


def footage(source: Source) -> Footage:
    """Return the footage of `source`, decoded once while it is asked for in a row.

    Raises
    ------
    InputError
        If it cannot be read, or is not what was planned with.
    """
    return _SHELF.footage(source)


def describe(
    locations: Sequence[str], topic: str | None, max_diff: float
) -> list[tuple[Source, dict[int, Truth]]]:
    """Look at recordings: what they are, and their truth by the number of its frame.

    Raises
    ------
    InputError
        If one cannot be read or has no truth, or two have one name.
    """
    names = _names(locations)
    return [_describe(location, names[location], topic, max_diff) for location in locations]


def _describe(
    location: str, name: str, topic: str | None, max_diff: float
) -> tuple[Source, dict[int, Truth]]:
    path = at_hand(location)
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
