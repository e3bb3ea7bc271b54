# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every encoding against numbers worked out by hand, and what must be refused."""

import array
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.formats.encodings import ENCODINGS, frame_of_message

RED, GREEN, BLUE = (200, 10, 30), (20, 220, 40), (5, 15, 250)
COLOURS = np.array([[RED, GREEN, BLUE], [BLUE, RED, GREEN]], np.uint8)


def padded(rows, padding=5):
    """Lay rows of bytes out with `padding` bytes of rubbish after each; return data and step."""
    rows = np.ascontiguousarray(rows).view(np.uint8).reshape(rows.shape[0], -1)
    filler = np.full((rows.shape[0], padding), 0xAB, np.uint8)
    return np.hstack([rows, filler]).tobytes(), rows.shape[1] + padding


def to_rgb(encoding, height, width, step, is_bigendian, data):
    return frame_of_message(
        SimpleNamespace(
            encoding=encoding, height=height, width=width, step=step, is_bigendian=is_bigendian,
            data=data,
        )
    )  # fmt: skip


def convert(encoding, rows, width, height=None, big=False, padding=5):
    data, step = padded(rows, padding)
    return to_rgb(encoding, height or rows.shape[0], width, step, big, data)


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8", "rgba8", "bgra8"])
def test_colour_orders_with_row_padding(encoding):
    rows = COLOURS if encoding.startswith("rgb") else COLOURS[..., ::-1]
    if "a" in encoding:
        alpha = np.full((2, 3, 1), 77, np.uint8)
        rows = np.concatenate([rows, alpha], axis=2)
    assert np.array_equal(convert(encoding, rows, 3), COLOURS)


def test_rgb8_is_a_view_of_the_message():
    data = np.arange(2 * 16, dtype=np.uint8)
    frame = to_rgb("rgb8", 2, 4, 16, False, data)
    assert np.shares_memory(frame, data)
    assert frame.strides == (16, 3, 1)


@pytest.mark.parametrize("wrap", [bytes, bytearray, memoryview, lambda b: array.array("B", b)])
def test_any_buffer_is_taken(wrap):
    data = wrap(COLOURS.tobytes())
    assert np.array_equal(to_rgb("rgb8", 2, 3, 9, False, data), COLOURS)


@pytest.mark.parametrize(("order", "big"), [("<u2", False), (">u2", True)])
def test_mono16_keeps_the_high_byte_in_both_byte_orders(order, big):
    values = np.array([[0x0000, 0x12FF, 0xFF00]], order)
    frame = convert("mono16", values, 3, big=big)
    assert frame[0, :, 0].tolist() == [0x00, 0x12, 0xFF]
    assert frame[0, :, 2].tolist() == [0x00, 0x12, 0xFF]


def test_grey_is_repeated_and_opencvs_names_are_grey_and_bgr():
    grey = np.array([[0, 128, 255]], np.uint8)
    for name in ("mono8", "8UC1"):
        assert np.array_equal(convert(name, grey, 3), np.repeat(grey[..., np.newaxis], 3, axis=2))
    assert np.array_equal(convert("8UC3", COLOURS[..., ::-1], 3), COLOURS)


@pytest.mark.parametrize(("order", "big"), [("<u2", False), (">u2", True)])
@pytest.mark.parametrize("offset", [0, 30_000])
def test_16uc1_is_scaled_by_its_own_range(order, big, offset):
    """14 bits of a thermal camera would lie in the lowest quarter, or in one grey value."""
    values = (np.arange(200, dtype=np.uint16) * 5 + offset).reshape(10, 20).astype(order)
    frame = convert("16UC1", values, 20, big=big)
    assert (frame.min(), frame.max()) == (0, 255)
    assert np.array_equal(frame[..., 0], frame[..., 2])
    # By hand: the percentiles of 0 to 995 are at 0.995 * 5 and 198.005 * 5.
    low, high = 4.975, 990.025
    expected = np.clip((values.astype(float) - offset - low) / (high - low), 0, 1) * 255
    assert np.abs(frame[..., 0] - expected).max() <= 0.51


def test_16uc1_passes_over_single_hot_pixels_and_takes_flat_images():
    values = np.tile(np.arange(1000, 1100, dtype="<u2"), (100, 1))
    plain = convert("16UC1", values, 100)
    values[5, 5] = 65_535
    assert np.abs(convert("16UC1", values, 100)[9:].astype(int) - plain[9:]).max() <= 1
    assert convert("16UC1", np.full((4, 6), 777, "<u2"), 6).max() == 0


def mosaic(pattern, colour, size=8):
    """Photograph one colour through a Bayer filter whose first pixels are `pattern` (rggb...)."""
    value = dict(zip("rgb", colour, strict=True))
    cell = np.array([value[letter] for letter in pattern], np.uint8).reshape(2, 2)
    return np.tile(cell, (size // 2, size // 2))


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
@pytest.mark.parametrize("colour", [RED, GREEN, BLUE])
def test_bayer_patterns_by_their_ros_names(pattern, colour):
    pixels = mosaic(pattern, colour)
    for name, data in (("8", pixels), ("16", pixels.astype("<u2") * 256 + 99)):
        frame = convert(f"bayer_{pattern}{name}", data, 8)
        assert np.array_equal(frame[2:-2, 2:-2], np.full((4, 4, 3), colour, np.uint8))


def bt601(y, u, v):
    """ITU-R BT.601, video range: what YUV images of cameras are coded in."""
    c, d, e = 1.164 * (y - 16), u - 128, v - 128
    rgb = np.array([c + 1.596 * e, c - 0.813 * e - 0.391 * d, c + 2.018 * d])
    return np.clip(rgb, 0, 255)


YUV = [(81, 90, 240), (145, 54, 34), (41, 240, 110), (180, 128, 128)]


@pytest.mark.parametrize("yuv", YUV)
@pytest.mark.parametrize(
    ("encoding", "order"),
    [("yuv422", "uyvy"), ("uyvy", "uyvy"), ("yuv422_yuy2", "yuyv"), ("yuyv", "yuyv")],
)
def test_yuv422_orders(encoding, order, yuv):
    value = dict(zip("yuv", yuv, strict=True))
    rows = np.tile(np.array([value[letter] for letter in order], np.uint8), (2, 3))
    frame = convert(encoding, rows, 6, padding=6)
    assert frame.shape == (2, 6, 3)
    assert np.abs(frame - bt601(*yuv)).max() <= 2


@pytest.mark.parametrize("yuv", YUV)
def test_nv12_with_row_padding(yuv):
    y, u, v = yuv
    rows = np.vstack([np.full((4, 6), y, np.uint8), np.tile(np.array([u, v], np.uint8), (2, 3))])
    frame = convert("nv12", rows, 6, height=4)
    assert frame.shape == (4, 6, 3)
    assert np.abs(frame - bt601(*yuv)).max() <= 2


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"encoding": "32FC1"}, "32FC1"),
        ({"height": 0}, "no pixels"),
        ({"width": 0}, "no pixels"),
        ({"width": -4}, "no pixels"),
        ({"width": 70000, "step": 210000}, "larger than"),
        ({"step": 11}, "shorter than one row"),
        ({"step": 13}, "needs 26 bytes of data, but has 24"),
        ({"encoding": "yuv422", "width": 3}, "odd"),
        ({"encoding": "nv12", "height": 1}, "odd"),
    ],
)
def test_what_makes_no_image_is_refused(change, said):
    good = {"encoding": "rgb8", "height": 2, "width": 4, "step": 12, "is_bigendian": False}
    with pytest.raises(InputError, match=said):
        to_rgb(**{**good, **change}, data=bytes(24))


@given(
    encoding=st.sampled_from(sorted(ENCODINGS)),
    height=st.integers(-1, 9),
    width=st.integers(-1, 9),
    step=st.integers(-1, 40),
    length=st.integers(0, 400),
)
def test_any_header_gives_a_frame_or_an_input_error(encoding, height, width, step, length):
    try:
        frame = to_rgb(encoding, height, width, step, False, bytes(length))
    except InputError:
        return
    assert frame.shape == (height, width, 3)
    assert frame.dtype == np.uint8
