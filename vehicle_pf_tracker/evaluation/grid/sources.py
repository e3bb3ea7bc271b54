# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The recordings of an evaluation: paths and URLs, their content, and their decoded frames."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from urllib.parse import urlsplit

from vehicle_pf_tracker.core.association import associate
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source, safe_name
from vehicle_pf_tracker.recordings.bags.bag_folder import recording_files
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.footage import Footage
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder, image_files
from vehicle_pf_tracker.recordings.recording_names import is_recording, is_url
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.recordings.url_copies import local_copy, recordings_at

FRAMES_BYTES = 1 << 30
"""Largest recording, in bytes of frames, that is decoded once: 1 GiB, a share of a small machine
that leaves room for a worker per core. Larger ones are decoded for each run."""
_BLOCK = 1 << 22
"""Bytes of a file that are digested at once, so that a recording of gigabytes needs no memory."""


def find_recordings(locations: Sequence[str]) -> list[str]:
    """Return the recordings that `locations` name, with folders of recordings spread out.

    What is none is left for `describe` to refuse.
    """
    recordings = [
        recording
        for location in locations
        for recording in (recordings_at(location) if is_url(location) else _at_path(Path(location)))
    ]
    # Named twice, as by a folder and by itself, it is one; the order stays.
    return list(dict.fromkeys(recordings))


def _local(location: str) -> Path:
    return local_copy(location) if is_url(location) else Path(location)


def _at_path(path: Path) -> list[str]:
    if is_recording(path) or not path.is_dir():
        return [str(path)]
    children = sorted(child for child in path.iterdir() if not child.name.startswith("."))
    inside = [child for child in children if is_recording(child)]
    if not inside and not image_files(path):
        inside = [child for child in children if image_files(child)]
    return [str(child) for child in inside or [path]]


class SourceFootage:
    """A local recording or folder of images: its truth, and its frames, readable repeatedly.

    Attributes
    ----------
    recording : Recording or Footage
        Source of the frames.
    truth : tuple of Truth
        True states of the vehicle, in order.
    """

    def __init__(self, source: Source) -> None:
        path = _local(source.path)
        self.recording = open_source(path, topic=source.topic or None, identity=source.identity)
        # Scores of another content would stand under this name, in the report and the cache.
        if _digest(self.recording, path) != source.digest:
            raise InputError(f"the recording {source.path} has changed since it was planned")
        self.truth = tuple(self.recording.truth())
        size = source.frames * source.width * source.height * 3
        self._kept = list(self._decoded()) if size <= FRAMES_BYTES else None

    def frames(self) -> Iterator[tuple[int, Frame | None]]:
        """Return the stamp (ns) and the frame of each image, in order."""
        return self._decoded() if self._kept is None else iter(self._kept)

    def _decoded(self) -> Iterator[tuple[int, Frame | None]]:
        return ((image.stamp_ns, image.frame) for image in self.recording.frames())


HELD: dict[Source, SourceFootage] = {}
"""The footage that was used last, at most one."""


def footage(source: Source) -> SourceFootage:
    """Return the footage of `source`, decoded once while it is asked for in a row.

    Raises
    ------
    InputError
        If it cannot be read, or is not what was planned with.
    """
    if source not in HELD:
        HELD.clear()  # so that two are never in memory
        HELD[source] = SourceFootage(source)
    return HELD[source]


def describe_recordings(
    locations: Sequence[str],
    topic: str | None,
    max_diff: float,
    on_stage: Callable[[str], object] = lambda _: None,
    identity: int | None = None,
) -> list[tuple[Source, dict[int, Truth]]]:
    """Describe recordings, and read their truth by the number of its frame.

    `on_stage` takes a few words before each; `identity` is the target's number in truth of several.

    Raises
    ------
    InputError
        If one cannot be read or has no truth, or two have one name.
    """
    names = _names(locations)
    described = []
    for location in locations:
        on_stage(f"reading {location}")
        path = _local(location)
        recording = open_source(path, topic=topic, identity=identity)
        truth = recording.truth()
        if not truth:
            hint = "; import it with truth, or track it with `vehicle-pf-tracker run`"
            why = ": " + "; ".join(recording.notices) if recording.notices else hint
            raise InputError(f"the recording {location} has no truth to compare with{why}")
        stamps = _stamps(recording)
        pairs = associate(stamps, [state.stamp_ns for state in truth], max_diff)
        if not pairs:
            raise InputError(
                f"no stamp of the truth in {location} is within {max_diff:g} s of an image's; "
                "a larger --max-diff may help"
            )
        # The size of the first image that can be read: one decoded picture, not all.
        facts = len(stamps), *_size(recording, location), _digest(recording, path)
        place = location if is_url(location) else str(path.absolute())
        source = Source(names[location], place, recording.image_topic, *facts, identity)
        described.append((source, {index + 1: truth[at] for index, at in pairs.items()}))
    return described


def _stamps(recording: Recording | Footage) -> list[int]:
    """Return the stamps of the images without decoding them."""
    if isinstance(recording, FrameFolder):
        return recording.stamps
    assert isinstance(recording, Recording)
    return [
        message.log_time_ns if message.stamp_ns is None else message.stamp_ns
        for message in recording.messages({recording.image_topic})
    ]


def _size(recording: Recording | Footage, location: str) -> tuple[int, int]:
    frames = (image.frame for image in recording.frames())
    first = next((frame for frame in frames if frame is not None), None)
    if first is None:
        raise InputError(f"the recording {location} has no image that can be read")
    return frame_size(first)


def _digest(recording: Recording | Footage, path: Path) -> str:
    """Digest the names and the bytes of the files of a recording, and the truth of a folder."""
    digest = hashlib.sha256()
    is_folder = isinstance(recording, FrameFolder)
    if is_folder:
        # Its truth may stand in files beside the images, which the loop below does not read.
        digest.update(repr(recording.truth()).encode())
    for file in image_files(path) if is_folder else recording_files(path)[0]:
        # With a separator, or a letter could move from a name to the content.
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
    path = PurePosixPath(urlsplit(location).path) if is_url(location) else Path(location).absolute()
    words = [*path.parts[-parts:-1], path.name.removesuffix(".mcap")]
    return safe_name("-".join(words))
