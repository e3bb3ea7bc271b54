# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""JPEG and PNG: what is decoded, and what is refused before that."""

import zlib

import cv2
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.formats import compressed_image
from vehicle_pf_tracker.image.formats.compressed_image import MAX_PIXELS, decode_compressed
from vehicle_pf_tracker.image.formats.encodings import LARGEST_SIDE_PX

RED, GREEN, BLUE = (200, 10, 30), (20, 220, 40), (5, 15, 250)
PNG = b"\x89PNG\r\n\x1a\n"
COLOURS = np.array([[RED, GREEN, BLUE], [BLUE, RED, GREEN]], np.uint8)


def coded(extension, image, *options):
    return cv2.imencode(extension, image, options)[1].tobytes()


def chunk(kind, data):
    checked = kind + data
    return len(data).to_bytes(4, "big") + checked + zlib.crc32(checked).to_bytes(4, "big")


def png(width, height):
    """A whole PNG of black RGB pixels that claims this size, whatever its one row of data."""
    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([8, 2, 0, 0, 0])
    row = zlib.compress(bytes(1 + 3 * 4))
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", row) + chunk(b"IEND", b"")
    return PNG + chunks


def jpeg(width, height, *options):
    """A JPEG of 24x16 px that claims another size in its frame header."""
    data = coded(".jpg", SMALL, *options)
    place = data.index(b"\x00\x10\x00\x18")
    return data[:place] + height.to_bytes(2, "big") + width.to_bytes(2, "big") + data[place + 4 :]


SMALL = np.random.default_rng(1).integers(0, 255, (16, 24, 3), np.uint8)
PROGRESSIVE = (cv2.IMWRITE_JPEG_PROGRESSIVE, 1)
WHOLE = [coded(".png", SMALL), coded(".jpg", SMALL), coded(".jpg", SMALL, *PROGRESSIVE)]


@pytest.fixture
def no_decoder(monkeypatch):
    def decode(*_):
        pytest.fail("it came to the decoder")

    monkeypatch.setattr(cv2, "imdecode", decode)


def test_png_keeps_every_pixel():
    assert np.array_equal(decode_compressed("png", coded(".png", COLOURS[..., ::-1])), COLOURS)


@pytest.mark.parametrize("options", [(), PROGRESSIVE])
def test_jpeg_keeps_the_order_of_the_channels(options):
    flat = np.full((16, 16, 3), RED, np.uint8)
    data = coded(".jpg", flat[..., ::-1], *options)
    frame = decode_compressed("rgb8; jpeg compressed bgr8", data)
    assert np.abs(frame.astype(int) - RED).max() <= 3


def test_what_cameras_put_before_the_frame_header_is_passed_over():
    """A thumbnail with a frame header of its own, fill bytes, stray bytes."""
    data = coded(".jpg", SMALL)
    thumbnail = jpeg(60_000, 60_000)
    segment = b"\xff\xe1" + (len(thumbnail) + 2).to_bytes(2, "big") + thumbnail
    assert decode_compressed("jpeg", data[:2] + segment + data[2:]).shape == (16, 24, 3)
    assert decode_compressed("jpeg", data[:2] + b"\xff\xff" + data[2:]).shape == (16, 24, 3)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "holds no data"),
        (b"not an image", "neither JPEG nor PNG"),
        (coded(".bmp", SMALL), "neither JPEG nor PNG"),
        (PNG + bytes(20), "cut off"),
        (PNG + b"\0\0\0\x0dIHDR\0\0", "cut off"),
        (PNG + chunk(b"tEXt", b"") + chunk(b"IEND", b""), "does not state its size"),
        (PNG + chunk(b"IHDR", b"") + chunk(b"IEND", b""), "does not state its size"),
        (b"\xff\xd8\xff\xd9", "does not state its size"),
        (b"\xff\xd8\xff\xe0\0\0" + bytes(20) + b"\xff\xd9", "does not state its size"),
        (b"\xff\xd8\xff\xc0\0\x11\x08\0\xff\xd9", "cut off"),
        (png(0, 0), "does not state its size"),
        (jpeg(0, 16), "does not state its size"),
    ],
)
def test_rubbish_is_refused(data, words):
    with pytest.raises(InputError, match=rf"^a compressed image \(format 'x'\) .*({words})"):
        decode_compressed("x", data)


@pytest.mark.parametrize("extension", [".jpg", ".png"])
@pytest.mark.parametrize("share", [0.3, 0.6, 0.99])
def test_a_cut_image_is_refused_rather_than_filled_with_grey(extension, share):
    data = coded(extension, np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8))
    with pytest.raises(InputError, match="cut off"):
        decode_compressed("jpeg", data[: int(share * len(data))])


@pytest.mark.usefixtures("no_decoder")
@pytest.mark.parametrize(
    ("bomb", "size"),
    [
        (png(30_000, 30_000), "30000x30000"),
        (png(LARGEST_SIDE_PX + 1, 1), "32768x1"),
        (png(6_000, 5_001), "6000x5001"),
        (png(2**32 - 1, 2**32 - 1), "4294967295x4294967295"),
        (jpeg(30_000, 30_000), "30000x30000"),
        (jpeg(1, 65_535), "1x65535"),
        (jpeg(65_535, 65_535, *PROGRESSIVE), "65535x65535"),
    ],
)
def test_what_claims_too_much_does_not_come_to_the_decoder(bomb, size):
    assert len(bomb) < 2000
    with pytest.raises(InputError, match=f"claims {size} px, above the 30 megapixels"):
        decode_compressed("png", bomb)


@pytest.mark.parametrize(
    "padding", [b"\0" * 5000, b"\xff" * 5000, b"\xff\xda\xff\xd9" * 900, b"\n"]
)
@pytest.mark.parametrize("options", [(), PROGRESSIVE])
def test_padding_behind_the_end_is_passed_over(padding, options):
    """Some cameras fill their buffers; it may be longer than the image."""
    data = coded(".jpg", SMALL, *options)
    assert np.array_equal(decode_compressed("x", data + padding), decode_compressed("x", data))


@pytest.mark.parametrize("length", [2000, 2**31 - 1, 2**32 - 1])
def test_a_chunk_that_claims_too_much_does_not_come_to_the_decoder(length):
    """OpenCV 5 makes room for what a chunk claims before it reads it: 4 GB, and half a minute."""
    bomb = PNG + chunk(b"IHDR", bytes(13)) + length.to_bytes(4, "big") + b"IDAT" + bytes(1000)
    with pytest.raises(InputError, match="cut off"):
        decode_compressed("png", bomb)


def test_the_largest_that_is_allowed_comes_to_the_decoder(monkeypatch):
    shown = []
    monkeypatch.setattr(cv2, "imdecode", lambda data, _: shown.append(len(data)))
    for size in ((6_000, 5_000), (LARGEST_SIDE_PX, 1)):
        with pytest.raises(InputError, match="damaged"):
            decode_compressed("jpeg", jpeg(*size))
    assert len(shown) == 2
    assert MAX_PIXELS == 6_000 * 5_000


CHANGES = st.lists(
    st.tuples(
        st.integers(0, 1000),
        st.sampled_from(["overwrite", "insert", "cut", "repeat"]),
        st.binary(min_size=1, max_size=8) | st.sampled_from([b"\xff", b"\xff\xc0", b"\xff\xd9"]),
    ),
    max_size=4,
)


def changed(data, changes):
    made = bytearray(data)
    for where, kind, new in changes:
        place = where % (len(made) + 1)
        if kind == "overwrite":
            made[place : place + len(new)] = new
        elif kind == "insert":
            made[place:place] = new
        elif kind == "cut":
            del made[place : place + len(new)]
        else:
            made[place:place] = made[: max(place, 1)]
    return bytes(made)


@given(whole=st.sampled_from(WHOLE), changes=CHANGES)
@example(whole=WHOLE[0], changes=[(33, "insert", png(48, 16)[8:33])])
@example(whole=WHOLE[1], changes=[(2, "insert", b"\xff\xc0\0\x11\x08\0\x10\0\x30\x03")])
def test_the_decoder_never_makes_more_than_was_allowed(whole, changes):
    """The limit here is the size of the whole image: any larger picture slipped past the check."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compressed_image, "MAX_PIXELS", 24 * 16)
        try:
            frame = decode_compressed("x", changed(whole, changes))
        except InputError:
            return
    assert frame.shape[0] * frame.shape[1] <= 24 * 16
    assert frame.dtype == np.uint8
