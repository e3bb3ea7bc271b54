# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sequences with truth, from recordings and frame folders, frame by frame in any order."""

from __future__ import annotations

import csv
import functools
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S, associate
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.image.formats.compressed_image import decode_compressed
from vehicle_pf_tracker.recordings.bags.bag_folder import recording_files
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.footage import stamp_of
from vehicle_pf_tracker.recordings.frame_folder import IMAGE_FORMATS, FrameFolder

CAMERAS = "cameras.csv"
"""Table beside the sequences that names each one's camera."""
_IN_MEMORY = 2
"""Sequences that a process keeps open; a recording's decoded frames are kept with it."""
_BLOCK = 1 << 22
"""Bytes that are read at once to make a digest of a file."""


@dataclass(frozen=True, slots=True)
class StressFootage:
    """A sequence, open for reading.

    Attributes
    ----------
    source : Source
        Name, path, size and digest of the footage.
    fps : float
        Frames per second.
    truth : tuple of Truth or None
        The truth of each frame.
    frame : callable
        Decodes the frame of an index from 0 to an RGB array.
    """

    source: Source
    fps: float
    truth: tuple[Truth | None, ...]
    frame: Callable[[int], Frame] = field(repr=False)

    @property
    def is_grey(self) -> bool:
        """True for footage without colour."""
        return is_grey(self.frame(0))


@dataclass(frozen=True, slots=True)
class StressSource:
    """A sequence of the battery and the camera that filmed it, the unit of cross-validation."""

    source: Source
    camera: str

    @property
    def name(self) -> str:
        """Name of the sequence in all tables."""
        return self.source.name


def is_grey(frame: Frame) -> bool:
    """Return whether the three channels of a frame are equal."""
    return bool(np.array_equal(frame[..., 0], frame[..., 1])) and bool(
        np.array_equal(frame[..., 0], frame[..., 2])
    )


def find_sequences(
    locations: Sequence[Path | str] | Path | str, cameras: Path | None = None
) -> list[StressSource]:
    """Find the sequences with truth in folders, at any depth.

    Parameters
    ----------
    locations : path or sequence of paths
        Recordings, frame folders (``img/``, ``groundtruth.csv``, ``sequence.json``), or folders
        that contain such. The name of a sequence is its path below its location.
    cameras : Path or None
        A table ``sequence,camera``; None takes a location's own `CAMERAS` where there is one. A
        sequence that is not in a table is its own camera.

    Raises
    ------
    InputError
        If there is none, one cannot be read or has no truth, two share a name, or a table names a
        sequence twice.
    """
    roots = [locations] if isinstance(locations, Path | str) else locations
    sources: dict[str, StressSource] = {}
    table = _read_cameras(cameras) if cameras else {}
    for root in map(Path, roots):
        own = root / CAMERAS
        # A table that was given holds for all locations.
        known = table or (_read_cameras(own) if own.is_file() else {})
        for path in _sequences_in(root):
            # By its path below the location: folders of data sets repeat names, as `img` and `gt`.
            name = path.relative_to(root).as_posix() if path != root else root.absolute().name
            name = name.removesuffix(".mcap")
            if name in sources:
                raise InputError(f"several sequences would be called {name}; rename a folder")
            sources[name] = StressSource(_describe(name, path), known.get(name, name))
    return list(sources.values())


@functools.lru_cache(maxsize=_IN_MEMORY)
def open_footage(source: Source) -> StressFootage:
    """Open a sequence; the last ones stay open.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    path = Path(source.path)
    if _is_frame_folder(path):
        return _open_folder(source, path)
    return _open_recording(source, path)


def _open_folder(source: Source, path: Path) -> StressFootage:
    folder = FrameFolder(path)
    files = list(folder.images.values())
    truths = [folder.truths.get(number) for number in folder.images]
    # Even stamps: a case has times of its own, by position.
    truth = tuple(
        None if known is None else replace(known, stamp_ns=stamp_of(index, folder.fps))
        for index, known in enumerate(truths)
    )

    def frame(index: int) -> Frame:
        file = files[index]
        return decode_compressed(IMAGE_FORMATS[file.suffix.lower()], file.read_bytes())

    return StressFootage(source, folder.fps, truth, frame)


def _open_recording(source: Source, path: Path) -> StressFootage:
    recording = Recording(path, source.topic)
    # Images that cannot be read are left out here; a case needs every frame that it plays.
    images = [image for image in recording.frames() if image.frame is not None]
    stamps = [image.stamp_ns for image in images]
    truths = recording.truth()
    pairs = associate(stamps, [truth.stamp_ns for truth in truths], PAIRED_WITHIN_S)
    frames = [image.frame for image in images]

    def frame(index: int) -> Frame:
        decoded = frames[index]
        assert decoded is not None
        return decoded

    # The median, as dropped images lengthen some of the intervals.
    fps = 1e9 / float(np.median(np.diff(stamps))) if len(stamps) > 1 else 30.0
    truth = tuple(truths[pairs[i]] if i in pairs else None for i in range(len(stamps)))
    return StressFootage(source, fps, truth, frame)


def _describe(name: str, path: Path) -> Source:
    if _is_frame_folder(path):
        folder = FrameFolder(path)
        if not folder.truths:
            raise InputError(f"the frame folder {path} has no truth to compare with")
        # Truth and frame rate are part of the footage: a change of either makes other scores.
        files = [*folder.images.values(), path / "groundtruth.csv", path / "sequence.json"]
        unsized = Source(name, str(path.absolute()), "", len(folder.images), 0, 0, _digest(files))
    else:
        recording = Recording(path)
        if not recording.truth():
            raise InputError(f"the recording {path} has no truth to compare with")
        unsized = Source(
            name,
            str(path.absolute()),
            recording.image_topic,
            recording.frame_count,
            0,
            0,
            _digest(recording_files(path)[0]),
        )
    width, height = frame_size(_first_frame(unsized, path))
    return replace(unsized, width=width, height=height)


def _first_frame(source: Source, path: Path) -> Frame:
    if source.topic:
        frames = (image.frame for image in Recording(path, source.topic).frames())
        return next(frame for frame in frames if frame is not None)
    return _open_folder(source, path).frame(0)


def _digest(files: Sequence[Path]) -> str:
    digest = hashlib.sha256()
    for file in files:
        # Names, too: the same files in another order are another sequence.
        digest.update(file.name.encode() + b"\0")
        with file.open("rb") as stream:
            while block := stream.read(_BLOCK):
                digest.update(block)
    return digest.hexdigest()


def _sequences_in(root: Path) -> list[Path]:
    if not root.exists():
        raise InputError(f"there is no sequence {root}")
    if _is_sequence(root):
        return [root]
    inside = sorted(path for path in root.rglob("*") if _is_sequence(path))
    # The MCAP file in a rosbag2 folder is part of the recording that was found already.
    sequences = [path for path in inside if path.parent not in inside]
    if not sequences:
        raise InputError(f"{root} has no recording and no frame folder with truth in it")
    return sequences


def _is_sequence(path: Path) -> bool:
    if path.is_file():
        return path.suffix == ".mcap"
    return _is_frame_folder(path) or (path / "metadata.yaml").is_file()


def _is_frame_folder(path: Path) -> bool:
    return (path / "img").is_dir() and (path / "groundtruth.csv").is_file()


def _read_cameras(path: Path) -> Mapping[str, str]:
    try:
        # With or without a byte order mark: spreadsheets write one.
        with path.open(newline="", encoding="utf-8-sig") as stream:
            rows = list(csv.DictReader(stream))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read the cameras {path}: {error}") from error
    table: dict[str, str] = {}
    for row in rows:
        name = row.get("sequence")
        camera = row.get("camera")
        if not name or not camera:
            raise InputError(f"the cameras {path} need the columns sequence,camera in every line")
        if name in table:
            raise InputError(f"the cameras {path} name the sequence {name} twice")
        table[name] = camera
    return table
