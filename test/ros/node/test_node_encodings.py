# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images of several encodings, sizes and contents, through a running node.

Every encoding is read in test/image/formats/test_encodings.py.
"""

from __future__ import annotations

import array

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from sensor_msgs.msg import Image
from tracker_rig import Rig, header

from vehicle_pf_tracker.trackers.session import Session

pytestmark = pytest.mark.ros

WIDTH, HEIGHT = 12, 8
ANY = np.random.default_rng(3).integers(0, 256, (HEIGHT, WIDTH, 3), np.uint8)
GREY = ANY[..., :1].repeat(3, axis=2)
HIGH = ANY[..., 0].astype(np.uint16) * 256 + 0x5A
"""The grey picture in the high bytes."""
CASES = [
    ("rgb8", ANY, ANY, False),
    ("bgr8", ANY[..., ::-1], ANY, False),
    ("mono8", ANY[..., 0], GREY, False),
    ("mono16", HIGH.astype("<u2"), GREY, False),
    ("mono16", HIGH.astype(">u2"), GREY, True),
]


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


@pytest.mark.parametrize("padding", [0, 6], ids=["packed", "padded"])
def test_the_tracker_is_shown_what_the_camera_saw(bench, shown, padding):
    rig = Rig(bench)
    for encoding, rows, expected, big in CASES:
        answer = rig.show(message_of(encoding, rows, big, padding))
        assert answer.status[0].message == "WAITING", encoding
        assert (shown[-1] == expected).all(), (encoding, big)
