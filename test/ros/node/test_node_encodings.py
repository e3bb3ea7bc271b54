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

"""Every encoding through Fast DDS: what the tracker is shown, against conversions by hand."""

from __future__ import annotations

import array

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from sensor_msgs.msg import Image
from tracker_rig import Rig, header, on_target, values_of

from vehicle_pf_tracker.image.encodings import ENCODINGS
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.trackers.session import Session

pytestmark = pytest.mark.ros

WIDTH, HEIGHT = 12, 8
PADDING = 6


def picture() -> np.ndarray:
    """Colours of all kinds: (HEIGHT, WIDTH, 3)."""
    return np.random.default_rng(3).integers(0, 256, (HEIGHT, WIDTH, 3), np.uint8)


def flat(colour) -> np.ndarray:
    """One colour: what a Bayer filter or shared chroma cannot blur."""
    return np.broadcast_to(np.array(colour, np.uint8), (HEIGHT, WIDTH, 3))


def grey(rgb: np.ndarray) -> np.ndarray:
    return rgb[..., :1].repeat(3, axis=2)


def bayer(pattern: str, rgb: np.ndarray) -> np.ndarray:
    """What a sensor with the filter `pattern` (rggb...) sees."""
    seen = np.empty((HEIGHT, WIDTH), np.uint8)
    for index, letter in enumerate(pattern):
        rows, columns = divmod(index, 2)
        seen[rows::2, columns::2] = rgb[rows::2, columns::2, "rgb".index(letter)]
    return seen


def ycc(rgb) -> np.ndarray:
    """ITU-R BT.601, video range; each of shape (H, W)."""
    matrix = np.array(
        [[65.738, 129.057, 25.064], [-37.945, -74.494, 112.439], [112.439, -94.154, -18.285]]
    )
    return np.round(np.asarray(rgb, float) @ matrix.T / 256 + [16, 128, 128]).astype(np.uint8)


def yuv422(order: str, rgb: np.ndarray) -> np.ndarray:
    luma, blue, red = np.moveaxis(ycc(rgb), -1, 0)
    first = {
        "y": iter((luma[:, ::2], luma[:, 1::2])),
        "u": iter((blue[:, ::2],)),
        "v": iter((red[:, ::2],)),
    }
    return np.stack([next(first[letter]) for letter in order], axis=-1).reshape(HEIGHT, -1)


def nv12(rgb: np.ndarray) -> np.ndarray:
    luma, blue, red = np.moveaxis(ycc(rgb), -1, 0)
    chroma = np.stack([blue[::2, ::2], red[::2, ::2]], axis=-1).reshape(HEIGHT // 2, WIDTH)
    return np.vstack([luma, chroma])


def sixteen(rows: np.ndarray, order: str) -> np.ndarray:
    """High byte `rows`, low byte something else."""
    return (rows.astype(np.uint16) * 256 + 0x5A).astype(f"{order}u2")


def alpha(rgb: np.ndarray) -> np.ndarray:
    return np.concatenate([rgb, np.full((HEIGHT, WIDTH, 1), 77, np.uint8)], axis=2)


ORANGE = flat((210, 120, 40))
ANY = picture()
PATTERNS = ("rggb", "bggr", "gbrg", "grbg")

CASES = [
    ("rgb8", ANY, ANY, False, 0),
    ("bgr8", ANY[..., ::-1], ANY, False, 0),
    ("rgba8", alpha(ANY), ANY, False, 0),
    ("bgra8", alpha(ANY[..., ::-1]), ANY, False, 0),
    ("mono8", ANY[..., 0], grey(ANY), False, 0),
    ("8UC1", ANY[..., 0], grey(ANY), False, 0),
    ("16UC1", 1000 + 7 * (ANY[..., 0] > 127).astype("<u2"), grey(255 * (ANY > 127)), False, 0),
    ("8UC3", ANY[..., ::-1], ANY, False, 0),
    ("mono16", sixteen(ANY[..., 0], "<"), grey(ANY), False, 0),
    ("mono16", sixteen(ANY[..., 0], ">"), grey(ANY), True, 0),
    *((f"bayer_{name}8", bayer(name, ORANGE), ORANGE, False, 0) for name in PATTERNS),
    *(
        (f"bayer_{name}16", sixteen(bayer(name, ORANGE), order), ORANGE, order == ">", 0)
        for name in PATTERNS
        for order in "<>"
    ),
    *((name, yuv422("uyvy", ORANGE), ORANGE, False, 3) for name in ("yuv422", "uyvy")),
    *((name, yuv422("yuyv", ORANGE), ORANGE, False, 3) for name in ("yuv422_yuy2", "yuyv")),
    ("nv12", nv12(ORANGE), ORANGE, False, 3),
]  # fmt: skip


def message_of(encoding: str, rows: np.ndarray, big: bool, padding: int) -> Image:
    """Lay the rows out with rubbish after each."""
    lines = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
    filler = np.full((len(rows), padding), 0xAB, np.uint8)
    data = np.hstack([lines, filler])
    return Image(
        header=header(0),
        height=HEIGHT,
        width=WIDTH,
        encoding=encoding,
        is_bigendian=int(big),
        step=data.shape[1],
        data=array.array("B", data.tobytes()),
    )


@pytest.fixture
def shown(monkeypatch):
    """The frames that the tracker is shown."""
    frames = []
    feed = Session.feed
    monkeypatch.setattr(
        Session,
        "feed",
        lambda self, frame, ns: frames.append(frame.copy()) or feed(self, frame, ns),
    )
    return frames


def test_every_encoding_is_tried():
    assert {case[0] for case in CASES} == set(ENCODINGS)


@pytest.mark.parametrize("padding", [0, PADDING], ids=["packed", "padded"])
def test_the_tracker_is_shown_what_the_camera_saw(bench, shown, padding):
    rig = Rig(bench)
    for encoding, rows, expected, big, tolerance in CASES:
        answer = rig.show(message_of(encoding, rows, big, padding))
        assert answer.status[0].message == "WAITING", encoding
        frame = shown[-1]
        edge = 2 if encoding.startswith("bayer") else 0  # where neighbours are missing
        inner = slice(edge, HEIGHT - edge), slice(edge, WIDTH - edge)
        difference = np.abs(frame[inner].astype(int) - expected[inner])
        assert difference.max() <= tolerance, (encoding, big)


@pytest.mark.parametrize(("width", "height"), [(1, 1), (3, 1), (1, 7), (5, 3), (161, 119)])
@pytest.mark.parametrize("encoding", ["rgb8", "mono8", "bayer_rggb8"])
def test_odd_sizes_are_shown(bench, shown, width, height, encoding):
    rig = Rig(bench)
    channels = 3 if encoding == "rgb8" else 1
    rows = np.random.default_rng(1).integers(0, 256, (height, width * channels), np.uint8)
    message = Image(
        header=header(0), height=height, width=width, encoding=encoding, step=width * channels,
        data=array.array("B", rows.tobytes()),
    )  # fmt: skip
    answer = rig.show(message)
    if encoding == "bayer_rggb8" and min(width, height) < 3:
        assert answer.status[0].message in {"WAITING", "REJECTED"}
        return
    assert answer.status[0].message == "WAITING"
    assert shown[0].shape == (height, width, 3)


@pytest.mark.parametrize("value", [0, 255, 128], ids=["black", "white", "grey"])
@pytest.mark.parametrize("variant", ["apf", "mfpf", "ms", "adaptive", "pfcl"])
def test_frames_of_one_value_are_survived(bench, variant, value):
    """Neither as a reference nor later do they make numbers that are none."""
    rig = Rig(bench, on_target(), variant=variant)
    empty = np.full((120, 160, 3), value, np.uint8)
    for index in range(6):
        answer = rig.show(image_message(header(index), empty))
        told = values_of(answer)
        assert answer.status[0].message in {"TRACKING", "OCCLUDED", "LOST"}
        for name in ("x", "y", "width", "height", "confidence", "n_eff"):
            assert np.isfinite(float(told[name])), name
        assert 0 <= float(told["confidence"]) <= 1
        assert 0 <= float(told["x"]) <= 160
        assert 0 <= float(told["y"]) <= 120
