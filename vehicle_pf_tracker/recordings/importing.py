# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Import video files and frame folders as recordings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.image.formats.compressed_image import jpeg
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.recordings.footage import Footage, Picture
from vehicle_pf_tracker.recordings.opened_footage import open_footage
from vehicle_pf_tracker.recordings.recording_names import is_recording

IMPORT_FORMATS = ("compressed", "raw")


def import_recording(  # noqa: PLR0913 - one for each option of the command
    source: Path,
    out: Path,
    *,
    truth: Path | None = None,
    identity: int | None = None,
    fps: float | None = None,
    format: str | None = None,  # noqa: A002 (named as the option of the command)
    progress: Callable[[int, int | None], None] | None = None,
    overwrite: bool = False,
) -> tuple[str, Sequence[str]]:
    """Import a video file, or a frame folder with its truth; return a summary and notices.

    Parameters
    ----------
    source : Path
        The video file or the frame folder.
    out : Path
        The rosbag2 folder to write.
    truth : Path or None
        File of the truth; None takes what lies beside the images of a folder.
    identity : int or None
        Number of the target, where the truth has several.
    fps : float or None
        Frame rate, 1/s; None takes what the source states.
    format : str or None
        ``compressed`` keeps JPEG and PNG files as they are and codes the frames of a video as JPEG;
        ``raw`` writes pixels. None writes what is lossy already compressed, PNG files raw.
    progress : callable or None
        Called after each image with the number done and the total, None where that is unknown.
    overwrite : bool
        Replace a recording that is there.

    Raises
    ------
    InputError
        For every fault of the source, and if `out` cannot be written.
    """
    _check_request(source, format)
    footage = open_footage(source, truth=truth, fps=fps, identity=identity)
    frames = 0
    truths = 0
    size = (0, 0)
    with RecordingWriter(out, overwrite=overwrite) as writer:
        for frames, picture in enumerate(_pictures(footage), start=1):
            size = _check_size(picture, size if frames > 1 else frame_size(picture.frame))
            # Bytes of a file are kept as they are: decoding and coding anew would lose quality.
            if coded := _coded(picture, format):
                writer.write_compressed(picture.stamp_ns, *coded)
            else:
                writer.write_image(picture.stamp_ns, picture.frame)
            if picture.truth is not None:
                writer.write_truth(picture.truth)
                truths += 1
            if progress is not None:
                progress(frames, footage.frame_count)
        # Inside the block, so that a recording without its truth is not kept.
        _check_truth(footage, truths)
    made = f"{frames} frames of {size[0]}x{size[1]} px at {footage.fps:g} frames/s"
    return f"{made}, {truths} with truth", footage.notices


def _check_request(source: Path, format: str | None) -> None:  # noqa: A002 (as the option)
    if format is not None and format not in IMPORT_FORMATS:
        raise InputError(
            f"the format {format!r} is unknown; choose from {', '.join(IMPORT_FORMATS)}"
        )
    if not source.exists():
        raise InputError(f"there is no file or folder {source} to import")
    if is_recording(source):
        raise InputError(f"{source} is a recording already")


def _check_truth(footage: Footage, truths: int) -> None:
    """Refuse truth of which no frame has an image, as of a video that ends before."""
    if footage.truth() and not truths:
        raise InputError(f"no frame of the truth has an image: {'; '.join(footage.notices)}")


def _pictures(footage: Footage) -> Iterator[Picture]:
    # A recording is made once and read often: an image that cannot be read is an error here.
    for picture in footage.frames():
        if not isinstance(picture, Picture):
            raise InputError(footage.notices[-1])
        yield picture


def _check_size(picture: Picture, size: tuple[int, int]) -> tuple[int, int]:
    # Recordings are played to trackers, which take images of one size.
    width, height = frame_size(picture.frame)
    if (width, height) != size:
        raise InputError(
            f"{picture.name} is {width}x{height} px, those before it {size[0]}x{size[1]}; "
            "a recording needs one size"
        )
    return size


def _coded(picture: Picture, wanted: str | None) -> tuple[str, bytes] | None:
    """Kind and bytes of the file that a picture is stored as; None where its pixels are."""
    # PNG is slow to decode, and as raw pixels no larger than what a camera publishes.
    if wanted == "raw" or (wanted is None and picture.coded_format == "png"):
        return None
    if picture.coded_format:
        return picture.coded_format, picture.coded
    return "jpeg", jpeg(picture.frame)
