# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Decoders of videos: OpenCV's, and PyAV's for what OpenCV cannot decode.

OpenCV's is the first because it is installed wherever the package is; AV1 is the commonest codec
that its wheels lack, and uncompressed video is what it crashes on. OpenCV's own complaints are kept
off the terminal where an error says the same in one sentence.
"""

from __future__ import annotations

import importlib
import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Protocol

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.recordings.recording_names import is_url

_SILENT = 0
"""OpenCV's level at which it logs nothing."""
_UNCONVERTED = int.from_bytes(b"BGR\x18", "little")
"""OpenCV's number of the pixel format BGR24. It takes such frames as they are, and overruns its
memory where the last row comes first, as in uncompressed AVIs of Windows: the process is aborted
(OpenCV 5.0.0)."""
_FAILED_READS = 64
"""Reads of a file that fail in a row before it is taken for ended. OpenCV fails once for damaged
frames and reads on behind them, and at the end fails for ever; 64 of those take 5 ms. A choice:
none of four damaged containers failed twice in a row."""
_QUARTER_TURN = 90
"""Degrees; phones state rotations of whole quarters."""

_MOST_BOXES = 10_000
"""Boxes of an MP4 that are searched for its index: a fragment a second has two for over an hour."""

_CODECS = {"AV01": "AV1", "HEV1": "HEVC", "HVC1": "HEVC", "VP09": "VP9"}
"""Common names of the four letters that files have."""

# The decoder's own complaints would go to the terminal beside our sentence.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")


class Decoder(Protocol):
    """Frames of a video, one after the other.

    Attributes
    ----------
    fps : float
        Frame rate that the file states, 1/s; nan or 0 without one.
    frame_count : int or None
        Number of frames that it states; None without one.
    size : (int, int)
        Width and height, px.
    codec : str
        Name of the codec.
    """

    fps: float
    frame_count: int | None
    size: tuple[int, int]
    codec: str

    def read(self) -> tuple[Frame, float] | None:
        """Return the next frame, RGB, and its time in ms (nan: none); None after the last."""

    def close(self) -> None:
        """Close the file."""


@contextmanager
def quiet_opencv() -> Iterator[None]:
    """Keep OpenCV from complaining on the terminal."""
    # OpenCV moved these functions between 4 and 5.
    logging: Any = getattr(cv2.utils, "logging", cv2)
    level = logging.getLogLevel()
    logging.setLogLevel(_SILENT)
    try:
        yield
    finally:
        logging.setLogLevel(level)


class OpenCVDecoder:
    """Decoder of OpenCV, for files, cameras and streams; see `Decoder`.

    It uses FFmpeg where OpenCV has it: other decoders complain on the terminal.

    Parameters
    ----------
    source : int or str
        Index of a camera, path or URL.

    Raises
    ------
    InputError
        If it cannot be opened; the sentence lacks its subject.
    """

    def __init__(self, source: int | str) -> None:
        # Without FFmpeg the order of OpenCV's own choice is as good as any.
        has_ffmpeg = cv2.CAP_FFMPEG in cv2.videoio_registry.getStreamBackends()
        backend = cv2.CAP_FFMPEG if has_ffmpeg and isinstance(source, str) else cv2.CAP_ANY
        with quiet_opencv():
            self._video = cv2.VideoCapture(source, backend)
        if not self._video.isOpened():
            raise InputError("cannot be opened")
        self.fps = float(self._video.get(cv2.CAP_PROP_FPS))
        stated = self._video.get(cv2.CAP_PROP_FRAME_COUNT)
        # Live sources state 0, less, or no number at all.
        self.frame_count = int(stated) if math.isfinite(stated) and stated > 0 else None
        sides = (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT)
        self.size = (int(self._video.get(sides[0])), int(self._video.get(sides[1])))
        # Masked: a code may be negative, which has no bytes.
        letters = int(self._video.get(cv2.CAP_PROP_FOURCC)) & 0xFFFFFFFF
        self.codec = letters.to_bytes(4, "little").decode("latin-1").strip("\0 ").upper()
        # Only FFmpeg states a format.
        stated_format = int(self._video.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT))
        self._crashes = has_ffmpeg and stated_format == _UNCONVERTED
        # What is live has ended with the first failure, and another read may wait for minutes.
        is_file = isinstance(source, str) and not is_url(source)
        self._reads = _FAILED_READS if is_file else 1
        if self._crashes:
            self.codec = self.codec or "uncompressed BGR"

    def read(self) -> tuple[Frame, float] | None:
        """Return the next frame and its time; see `Decoder`."""
        if self._crashes:
            return None
        for _ in range(self._reads):
            is_read, image = self._video.read()
            if is_read:
                break
        else:
            return None
        time_ms = float(self._video.get(cv2.CAP_PROP_POS_MSEC))
        return cv2.cvtColor(image, cv2.COLOR_BGR2RGB), time_ms  # type: ignore[return-value]

    def close(self) -> None:
        """Close the file."""
        self._video.release()


class AvDecoder:
    """Decoder of PyAV; see `Decoder`.

    Parameters
    ----------
    source : str
        Path or URL.

    Raises
    ------
    InputError
        If PyAV is not installed, or cannot open it; the sentence lacks its subject.
    """

    def __init__(self, source: str) -> None:
        try:
            av = importlib.import_module("av")
        except ImportError:
            raise InputError("is not installed (pip install 'vehicle_pf_tracker[video]')") from None
        self._failures = (av.error.FFmpegError, ValueError)
        try:
            self._container = av.open(source)
        except self._failures as error:
            raise InputError(f"cannot be opened ({error})") from None
        if not self._container.streams.video:
            self._container.close()
            raise InputError("has no video")
        # The first of several: a file may have a cover image beside its video.
        stream = self._container.streams.video[0]
        # Frames are decoded ahead in threads, in the same order.
        stream.thread_type = "AUTO"
        self.fps = float(stream.average_rate or math.nan)
        self.frame_count = stream.frames or None
        self.size = (stream.width, stream.height)
        self.codec = stream.codec_context.name.upper()
        start = stream.start_time
        # Some containers start late; the first frame is at 0 ms here, as with OpenCV.
        self._start_s = float(start * stream.time_base) if start is not None else 0.0
        self._frames = self._decoded(stream)

    def read(self) -> tuple[Frame, float] | None:
        """Return the next frame and its time; see `Decoder`."""
        frame = next(self._frames, None)
        if frame is None:
            return None
        # Phones store upright videos on their side; OpenCV turns them too.
        image = np.rot90(frame.to_ndarray(format="rgb24"), round(frame.rotation / _QUARTER_TURN))
        time_ms = math.nan if frame.time is None else (frame.time - self._start_s) * 1e3
        return np.ascontiguousarray(image), time_ms

    def close(self) -> None:
        """Close the file."""
        self._container.close()

    def _decoded(self, stream: Any) -> Iterator[Any]:
        """Yield the frames that can be decoded, also those behind damaged ones, as OpenCV does."""
        packets = self._container.demux(stream)
        while True:
            try:
                packet = next(packets, None)
            except self._failures:  # the container itself is cut
                return
            if packet is None:
                return
            with suppress(*self._failures):
                yield from packet.decode()


def open_decoder(source: Path | str) -> Decoder:
    """Open a video with the first decoder that decodes a frame of it, at its first frame.

    Raises
    ------
    InputError
        If none does.
    """
    # A relative name with a colon, as of a time of day, would be a protocol for FFmpeg.
    name = str(source) if is_url(source) else str(Path(source).absolute())
    codec, failure = _tried(OpenCVDecoder, name)
    if not failure:
        # Opened anew, as the trial has read the first frame.
        return OpenCVDecoder(name)
    other_codec, other_failure = _tried(AvDecoder, name)
    if not other_failure:
        return AvDecoder(name)
    # The codec is known even where its frames are not: it is what the user can do something about.
    codec = codec or other_codec
    if not codec:
        raise InputError(f"{source} is not a video file that can be decoded{_cause(Path(name))}")
    raise InputError(
        f"no frame of the video {source} can be decoded: its codec is {_CODECS.get(codec, codec)}; "
        f"OpenCV {failure}, and PyAV {other_failure}"
    )


def _cause(path: Path) -> str:
    """Return what is wrong with a file that is no video, to be put behind a sentence."""
    if not path.is_file():
        return ""
    size = path.stat().st_size
    if not size:
        return "; it is empty"
    # An MP4 or MOV is a row of boxes: 4 bytes of length, big-endian, 4 of type, and content. Their
    # index is written last, and without it no frame is found.
    types: list[bytes] = []
    at = 0
    with path.open("rb") as file:
        while at < size and len(types) < _MOST_BOXES:
            file.seek(at)
            head = file.read(16)
            types.append(head[4:8])
            length = int.from_bytes(head[:4], "big")
            # 1 stands for a length of 8 bytes behind the type, 0 for the rest of the file.
            at += (int.from_bytes(head[8:], "big") if length == 1 else length) or size
    if types[0] == b"ftyp" and b"moov" not in types:
        return "; its end with the index (moov) is missing: it broke off, or was not closed"
    return ""


def _tried(kind: Callable[[str], Decoder], name: str) -> tuple[str, str]:
    """Return the codec of a video, and why its first frame cannot be decoded; empty if it can."""
    try:
        decoder = kind(name)
    except InputError as error:
        return "", str(error)
    # A frame, not the header, shows whether the codec is there.
    is_decoded = decoder.read() is not None
    decoder.close()
    return decoder.codec, "" if is_decoded else "cannot decode it"
