# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Videos that one decoder reads and the other does not, in files of any name."""

import itertools
import struct
import sys
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_recordings import COUNT, frame_of, write_video

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.decoders import AvDecoder, OpenCVDecoder, open_decoder
from vehicle_pf_tracker.recordings.importing import import_recording
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.showing.video_file import video_writer

av = pytest.importorskip("av")
START = 1_000_000_000


def encode(path, codec="libx264", rate=25, count=COUNT, fmt="yuv420p"):
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=rate)
        stream.width, stream.height, stream.pix_fmt = 96, 64, fmt
        for index in range(count):
            picture = av.VideoFrame.from_ndarray(frame_of(index), "rgb24")
            container.mux(stream.encode(picture))
        container.mux(stream.encode())
    return path


def frames_of(decoder):
    frames = list(iter(decoder.read, None))
    decoder.close()
    return frames


def test_both_decoders_give_the_same_frames_and_times(tmp_path):
    path = str(encode(tmp_path / "v.mp4"))
    one, other = OpenCVDecoder(path), AvDecoder(path)
    facts = ("fps", "frame_count", "size")
    assert [getattr(one, name) for name in facts] == [getattr(other, name) for name in facts]
    pairs = list(zip(frames_of(one), frames_of(other), strict=True))
    assert len(pairs) == COUNT
    for (frame, time_ms), (other_frame, other_ms) in pairs:
        assert time_ms == pytest.approx(other_ms, abs=0.01)
        # Two conversions to RGB differ by rounding, and at edges by their chroma filters.
        assert np.abs(frame.astype(int) - other_frame).mean() < 4


@pytest.mark.parametrize("turn", [(0, 1, -1, 0), (0, -1, 1, 0), (-1, 0, 0, -1)])
def test_both_decoders_turn_what_a_phone_took(tmp_path, turn):
    path = encode(tmp_path / "v.mp4")
    content = path.read_bytes()
    upright = struct.pack(">9i", 1 << 16, 0, 0, 0, 1 << 16, 0, 0, 0, 1 << 30)
    a, b, c, d = (number << 16 for number in turn)
    turned = struct.pack(">9i", a, b, 0, c, d, 0, 0, 0, 1 << 30)
    head = content.index(b"tkhd")
    at = content.index(upright, head)
    path.write_bytes(content[:at] + turned + content[at + len(turned) :])
    (one, _), (other, _) = (kind(str(path)).read() for kind in (OpenCVDecoder, AvDecoder))
    assert one.shape == other.shape
    assert np.abs(one.astype(int) - other).mean() < 4


@pytest.mark.skipif("libsvtav1" not in av.codecs_available, reason="PyAV has no encoder of AV1")
def test_av1_is_read(tmp_path):
    source = open_source(encode(tmp_path / "v.mp4", "libsvtav1"))
    images = list(source.frames())
    assert [image.stamp_ns - START for image in images] == [n * 40_000_000 for n in range(COUNT)]
    assert (source.fps, source.frame_count) == (25, COUNT)
    red = images[0].frame[28:32, 12:20].reshape(-1, 3).mean(axis=0)
    assert red == pytest.approx([200, 30, 30], abs=25)


@pytest.fixture
def no_opencv(monkeypatch):
    """Let OpenCV open videos, and decode none."""
    monkeypatch.setattr(OpenCVDecoder, "read", lambda _: None)


@pytest.mark.usefixtures("no_opencv")
def test_without_pyav_the_codec_and_the_remedy_are_named(tmp_path, monkeypatch):
    path = encode(tmp_path / "v.mp4")
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(InputError, match=r"codec is (H264|AVC1); .*pip install .*\[video\]"):
        open_source(path)


@pytest.mark.usefixtures("no_opencv")
def test_what_opencv_does_not_decode_pyav_does(tmp_path):
    assert len(list(open_source(encode(tmp_path / "v.mp4")).frames())) == COUNT


@pytest.mark.usefixtures("no_opencv")
def test_a_file_that_is_cut_ends_there(tmp_path):
    path = write_video(tmp_path / "v.avi", [frame_of(n) for n in range(COUNT)])
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    source = open_source(path)
    read = len(list(source.frames()))
    assert 2 < read < COUNT
    assert any(f"{read} could be read; it ends after" in notice for notice in source.notices)


@pytest.mark.parametrize("start", [0, 10])
@pytest.mark.parametrize("decoder", [OpenCVDecoder, AvDecoder])
def test_frames_behind_damaged_ones_are_read(tmp_path, monkeypatch, decoder, start):
    """The first two images of sixteen, or two in the middle, are no JPEG any more."""
    if decoder is AvDecoder:
        monkeypatch.setattr(OpenCVDecoder, "read", lambda _: None)
    path = encode(tmp_path / "v.avi", "mjpeg", count=16, fmt="yuvj420p")
    whole = [image.frame for image in open_source(path).frames()]
    content = path.read_bytes()
    at = [n for n in range(len(content)) if content.startswith(b"\xff\xd8\xff", n)]
    assert len(at) == 16
    damaged = bytearray(content)
    for begin, end in itertools.pairwise(at[start : start + 3]):
        damaged[begin : end - 8] = bytes(end - 8 - begin)  # between chunks 8 bytes name the next
    path.write_bytes(damaged)
    source = open_source(path)
    read = [image.frame for image in source.frames()]
    expected = whole[:start] + whole[start + 2 :]
    assert all((one == other).all() for one, other in zip(read, expected, strict=True))
    (notice,) = source.notices
    assert notice.endswith(
        "states 16 frames, 14 could be read, to its end: its frame rate varies, "
        "or others are damaged"
    )


def test_frames_of_a_variable_rate_reach_the_end_that_a_length_states(tmp_path):
    """Matroska states a length of .96 s, which is 24 periods, and 12 frames are in it."""
    path = tmp_path / "v.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=25)
        stream.width, stream.height, stream.pix_fmt = 96, 64, "yuv420p"
        stream.codec_context.time_base = Fraction(1, 25)
        for index in range(12):
            picture = av.VideoFrame.from_ndarray(frame_of(index), "rgb24")
            picture.pts = index if index < 6 else 3 * index - 12
            picture.time_base = Fraction(1, 25)
            container.mux(stream.encode(picture))
        container.mux(stream.encode())
    source = open_source(path)
    assert len(list(source.frames())) == 12
    (notice,) = source.notices
    assert notice.endswith(
        "12 could be read, to its end: its frame rate varies, or others are damaged"
    )


def test_truth_after_the_cut_of_a_video_is_refused(tmp_path):
    path = write_video(tmp_path / "v.avi", [frame_of(n) for n in range(COUNT)])
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    truth = tmp_path / "t.csv"
    truth.write_text(f"frame,x,y,w,h\n{COUNT},8,24,16,12\n")
    with pytest.raises(InputError, match=r"no frame of the truth has an image: .* could be read"):
        import_recording(path, tmp_path / "bag", truth=truth)
    assert not (tmp_path / "bag").exists()


@pytest.mark.parametrize("content", [b"", b"no video", b"\x00\x00\x00\x18ftypmp42" + bytes(99)])
def test_what_is_no_video_is_said(tmp_path, content):
    path = tmp_path / "v.mp4"
    path.write_bytes(content)
    with pytest.raises(InputError, match="is not a video file that can be decoded"):
        open_source(path)


def test_a_video_that_broke_off_is_told_from_what_is_none(tmp_path):
    whole = encode(tmp_path / "v.mp4").read_bytes()
    cut = tmp_path / "cut.mp4"
    cut.write_bytes(whole[: whole.index(b"moov")])
    empty = tmp_path / "empty.mp4"
    empty.touch()
    text = tmp_path / "text.mp4"
    text.write_text("no video, and longer than a head")
    for path, cause in ((cut, "; its end with the index .* missing"), (empty, "; it is empty")):
        with pytest.raises(InputError, match=f"can be decoded{cause}"):
            open_decoder(path)
    with pytest.raises(InputError, match=r"can be decoded$"):
        open_decoder(text)


NAMES = [
    "2026-11-26T10:00:00.mp4",
    "cam:1.mp4",
    "file:a.mp4",
    "concat:a|b.mp4",
    "http:a.mp4",
    "100% %03d.mp4",
    "-i.mp4",
    "a b'c\"d.mp4",
    "a?b#c.mp4",
    "vidéo.mp4",
    "a:/b.mp4",
    "a://b.mp4",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("decoder", [OpenCVDecoder, AvDecoder])
def test_files_of_any_name_are_read(tmp_path, monkeypatch, name, decoder):
    if decoder is AvDecoder:
        monkeypatch.setattr(OpenCVDecoder, "read", lambda _: None)
    monkeypatch.chdir(tmp_path)
    video = encode(tmp_path / "v.mp4", count=3)
    place = tmp_path / name
    place.parent.mkdir(exist_ok=True)
    video.rename(place)
    assert len(list(open_source(name).frames())) == 3


def test_a_video_of_any_name_is_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with video_writer(Path("10:00:00.mp4"), (96, 64), 25) as write:
        write(frame_of(0), 0.0)
    assert len(list(open_source("10:00:00.mp4").frames())) == 1


def test_a_url_that_is_no_file_stays_a_url():
    assert is_url("rtsp://10.0.0.1/a")
    assert is_url("https://example.org/" + "a" * 5000)
    with pytest.raises(InputError, match="is not a video file"):
        open_decoder("file:///nothing.mp4")


@pytest.fixture
def uncompressed(tmp_path, monkeypatch):
    """Make an uncompressed AVI as Windows has them, and fail where OpenCV is to decode it.

    Their height is positive, which says that the last row comes first; OpenCV 5.0.0 aborts then.
    """

    real = cv2.VideoCapture

    class Opened:
        # Not derived: Python's collector does not bear classes that are derived from OpenCV's.
        def __init__(self, *arguments):
            video = real(*arguments)
            self.isOpened, self.get, self.release = video.isOpened, video.get, video.release

        def read(self):
            raise AssertionError("OpenCV would have aborted the process")

    path = tmp_path / "v.avi"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("rawvideo", rate=25)
        stream.width, stream.height, stream.pix_fmt = 96, 64, "bgr24"
        for index in range(COUNT):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame_of(index), "rgb24")))
    content = path.read_bytes()
    downwards = struct.pack("<ii", 96, -64)
    assert content.count(downwards) == 1
    path.write_bytes(content.replace(downwards, struct.pack("<ii", 96, 64)))
    monkeypatch.setattr(cv2, "VideoCapture", Opened)
    return path


def test_what_opencv_crashes_on_pyav_decodes(uncompressed):
    decoder = open_decoder(uncompressed)
    frames = frames_of(decoder)
    assert isinstance(decoder, AvDecoder)
    assert len(frames) == COUNT
    for index, (frame, _) in enumerate(frames):
        # The header turned the rows over, and nothing else.
        np.testing.assert_array_equal(frame[::-1], frame_of(index))


def test_what_opencv_crashes_on_is_refused_without_pyav(uncompressed, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(InputError, match=r"codec is uncompressed BGR; .*pip install .*\[video\]"):
        open_decoder(uncompressed)


def test_opencv_is_the_first(tmp_path):
    path = write_video(tmp_path / "v.avi", [frame_of(0)])
    assert isinstance(open_decoder(path), OpenCVDecoder)
    assert cv2.videoio_registry.getBackends()
