# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Camera images of every common ROS encoding as RGB frames.

The encoding names are those of `sensor_msgs/image_encodings.hpp`. The node and the offline tools
call these same functions, so that both see the same numbers.
"""

from __future__ import annotations

import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.errors import InputError, brief
from vehicle_pf_tracker.core.frame import Frame, frame_size

Bytes: TypeAlias = npt.NDArray[np.uint8]
Buffer: TypeAlias = "bytes | bytearray | memoryview | array.array[int] | Bytes"

LARGEST_SIDE_PX = 32767
"""Longest side in px: the limit of OpenCV's 16-bit coordinates."""


_TAILS = (0.5, 99.5)
"""Percentiles of 16UC1 that become black and white: single hot or dead pixels do not count."""
_SAMPLED = 128
"""Rows and columns that the percentiles are taken from: enough for half a percent, in 2 ms."""


@dataclass(frozen=True, slots=True)
class _Encoding:
    """Memory layout of an encoding, and its conversion to RGB.

    `rows` is the height of the data in units of the image's height (NV12 has its colour plane
    below the grey one); `even` marks chroma that is shared by pixel pairs.
    """

    pixel_bytes: int
    convert: Callable[[Bytes, bool], Any]
    rows: float = 1.0
    even: bool = False


def frame_of_message(message: Any) -> Frame:
    """Read a `sensor_msgs/Image` as an RGB frame.

    `rgb8` is returned as a view of the data, rows `step` bytes apart; everything else is converted
    into a new array. 16-bit values keep their high byte; those of `16UC1`, which thermal cameras
    send with 10 to 16 bits in use, are scaled by the image's own range instead, so that two images
    of a scene may differ in brightness.

    Parameters
    ----------
    message : sensor_msgs/Image
        Its encoding is one of `ENCODINGS`, its data any buffer of at least ``step * height`` bytes
        (NV12: half as many again).

    Returns
    -------
    Frame
        RGB, shape (height, width, 3).

    Raises
    ------
    InputError
        If the encoding is unknown, the size is zero, odd where pixels share their colour, or above
        `LARGEST_SIDE_PX`, `step` is shorter than a row, or the data are shorter than the image.
    """
    layout = ENCODINGS.get(message.encoding)
    if layout is None:
        known = " ".join(ENCODINGS)
        raise InputError(
            f"the image encoding {brief(message.encoding)} is unknown; these are read: {known}"
        )
    _check_layout(layout, message)
    # Checked first, so that OpenCV sees only what it can convert.
    frame: Frame = layout.convert(_pixels(layout, message), bool(message.is_bigendian))
    return frame


def fields_of_frame(frame: Frame) -> dict[str, Any]:
    """Return what a `sensor_msgs/Image` says of its data, a contiguous RGB frame."""
    width, height = frame_size(frame)
    size = {"height": height, "width": width, "step": 3 * width}
    return {**size, "encoding": "rgb8", "is_bigendian": 0}


def flat_bytes(data: Buffer) -> Bytes:
    """View a buffer as an array of its bytes."""
    if isinstance(data, np.ndarray):
        return data.reshape(-1)
    return np.frombuffer(data, np.uint8)


def _check_layout(layout: _Encoding, message: Any) -> None:
    width = message.width
    height = message.height
    step = message.step
    size = f"{width}x{height} px in {message.encoding}"
    if height <= 0 or width <= 0:
        raise InputError(f"an image of {size} has no pixels")
    if max(height, width) > LARGEST_SIDE_PX:
        raise InputError(
            f"an image of {size} is larger than {LARGEST_SIDE_PX} px; is the message broken?"
        )
    # Checked here: OpenCV would fail with its own words, or read the next row.
    if layout.even and (width % 2 or (layout.rows > 1 and height % 2)):
        raise InputError(f"an image of {size} is odd, but pixels share their colour in pairs")
    if step < width * layout.pixel_bytes:
        raise InputError(f"an image of {size} has a step of {step} bytes, shorter than one row")


def _pixels(layout: _Encoding, message: Any) -> Bytes:
    """View the data without row padding: (rows, width) or (rows, width, bytes of a pixel)."""
    width = message.width
    step = message.step
    # Drivers pad rows, and send more bytes than the image needs: only too few are a mistake.
    flat = flat_bytes(message.data)
    rows = int(message.height * layout.rows)
    if flat.size < step * rows:
        raise InputError(
            f"an image of {width}x{message.height} px with a step of {step} bytes needs "
            f"{step * rows} bytes of data, but has {flat.size}"
        )
    packed = flat[: step * rows].reshape(rows, step)[:, : width * layout.pixel_bytes]
    return packed if layout.pixel_bytes == 1 else packed.reshape(rows, width, layout.pixel_bytes)


def _high_byte(pixels: Bytes, is_bigendian: bool) -> Bytes:
    return np.ascontiguousarray(pixels[..., 0 if is_bigendian else 1])


def _stretched(pixels: Bytes, is_bigendian: bool) -> Bytes:
    """Scale 16-bit values from the darkest to the brightest percentile to 0 to 255."""
    # A table of all 65536 values is faster than arithmetic on each pixel.
    values = np.ascontiguousarray(pixels).view(">u2" if is_bigendian else "<u2")[..., 0]
    sample = values[:: max(values.shape[0] // _SAMPLED, 1), :: max(values.shape[1] // _SAMPLED, 1)]
    low, high = np.percentile(sample, _TAILS)
    every = np.arange(2**16, dtype=np.float64)
    # An even image has no range: divided by one level, it becomes black and not a fault.
    greys = np.rint(np.clip((every - low) * (255.0 / max(high - low, 1.0)), 0, 255))
    return np.asarray(greys.astype(np.uint8)[values])


def _by_opencv(code: int, pixel_bytes: int, **layout: Any) -> _Encoding:
    return _Encoding(pixel_bytes, lambda pixels, _: cv2.cvtColor(pixels, code), **layout)


def _by_opencv_16(code: int) -> _Encoding:
    return _Encoding(2, lambda pixels, big: cv2.cvtColor(_high_byte(pixels, big), code))


# ROS names a Bayer pattern by the first two pixels of the first two rows, OpenCV by the second and
# third pixel of the second row.
_BAYER = {
    "bayer_rggb": cv2.COLOR_BayerBG2RGB,
    "bayer_bggr": cv2.COLOR_BayerRG2RGB,
    "bayer_gbrg": cv2.COLOR_BayerGR2RGB,
    "bayer_grbg": cv2.COLOR_BayerGB2RGB,
}

ENCODINGS: dict[str, _Encoding] = {
    "rgb8": _Encoding(3, lambda pixels, _: pixels),
    "bgr8": _by_opencv(cv2.COLOR_BGR2RGB, 3),
    "rgba8": _by_opencv(cv2.COLOR_RGBA2RGB, 4),
    "bgra8": _by_opencv(cv2.COLOR_BGRA2RGB, 4),
    "mono8": _by_opencv(cv2.COLOR_GRAY2RGB, 1),
    "mono16": _by_opencv_16(cv2.COLOR_GRAY2RGB),
    # OpenCV's names for its arrays, as nodes send them that fill in no colour space: BGR, as there.
    "8UC1": _by_opencv(cv2.COLOR_GRAY2RGB, 1),
    "8UC3": _by_opencv(cv2.COLOR_BGR2RGB, 3),
    "16UC1": _Encoding(
        2, lambda pixels, big: cv2.cvtColor(_stretched(pixels, big), cv2.COLOR_GRAY2RGB)
    ),
    **{f"{name}8": _by_opencv(code, 1) for name, code in _BAYER.items()},
    **{f"{name}16": _by_opencv_16(code) for name, code in _BAYER.items()},
    "yuv422": _by_opencv(cv2.COLOR_YUV2RGB_UYVY, 2, even=True),
    "uyvy": _by_opencv(cv2.COLOR_YUV2RGB_UYVY, 2, even=True),
    "yuv422_yuy2": _by_opencv(cv2.COLOR_YUV2RGB_YUY2, 2, even=True),
    "yuyv": _by_opencv(cv2.COLOR_YUV2RGB_YUY2, 2, even=True),
    "nv12": _by_opencv(cv2.COLOR_YUV2RGB_NV12, 1, rows=1.5, even=True),
}
"""Supported encodings by ROS name."""
