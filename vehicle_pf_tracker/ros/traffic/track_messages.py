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

"""Messages about all vehicles of an image."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from vehicle_pf_tracker.evaluation.traffic.drawing import NEUTRAL, identity_colour
from vehicle_pf_tracker.ros.messages import LEVELS, key_values, packed
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

CODES: Mapping[TrackMode, int] = MappingProxyType(
    {mode: code for code, mode in enumerate(TrackMode)}
)
"""Modes in `~/tracks`: 0 TENTATIVE, 1 TRACKING, 2 OCCLUDED, 3 LOST."""

_FLOATS = ("x", "y", "width", "height", "vx", "vy")
_TRACK = np.dtype(
    {
        "names": ["id", *_FLOATS, "mode", "confidence"],
        "formats": ["<u4", *["<f4"] * len(_FLOATS), "u1", "<f4"],
        "offsets": [0, 4, 8, 12, 16, 20, 24, 28, 32],
        "itemsize": 36,
    }
)
_DATATYPES = {"<u4": PointField.UINT32, "|u1": PointField.UINT8, "<f4": PointField.FLOAT32}


def _field(name: str) -> PointField:
    assert _TRACK.fields is not None
    kind, offset = _TRACK.fields[name][:2]
    return PointField(name=name, offset=offset, datatype=_DATATYPES[kind.str], count=1)


_FIELDS = [_field(name) for name in _TRACK.names or ()]
_LINE_WIDTH = 2.0
"""Width of the lines of boxes in px."""
_LETTERS = 14.0
"""Height of numbers in px."""


def tracks_message(
    header: Header, estimates: Sequence[TrackEstimate], frame_period: float
) -> PointCloud2:
    """Make the cloud with a point for each vehicle: centre and size in px, velocity in px/s."""
    points = np.zeros(len(estimates), _TRACK)
    for point, one in zip(points, estimates, strict=True):
        vx, vy = one.velocity[0] / frame_period, one.velocity[1] / frame_period
        point["id"], point["mode"] = one.identity, CODES[one.mode]
        point["confidence"] = one.confidence
        values = (*one.position, one.box.width, one.box.height, vx, vy)
        for name, value in zip(_FLOATS, values, strict=True):
            point[name] = value
    return PointCloud2(
        header=header,
        height=1,
        width=len(points),
        fields=_FIELDS,
        is_bigendian=False,
        point_step=_TRACK.itemsize,
        row_step=_TRACK.itemsize * len(points),
        data=packed(points.view(np.uint8)),
        is_dense=True,
    )


def scalars(estimate: TrackEstimate) -> dict[str, object]:
    """Return every scalar of an estimate by the name that `~/mode` and `~/modes` use."""
    return {
        "mode": estimate.mode.value,
        "id": estimate.identity,
        "x": estimate.position[0],
        "y": estimate.position[1],
        "width": estimate.box.width,
        "height": estimate.box.height,
        "velocity_x": estimate.velocity[0],
        "velocity_y": estimate.velocity[1],
        "confidence": estimate.confidence,
        "label": estimate.label,
        "score": estimate.score,
        "age": estimate.age,
        "hidden_by": "" if estimate.hidden_by is None else estimate.hidden_by,
    }


def modes_message(
    header: Header, node: str, hardware_id: str, estimates: Iterable[TrackEstimate]
) -> DiagnosticArray:
    """Make the status of each vehicle, with every scalar of its estimate."""
    status = [
        DiagnosticStatus(
            level=LEVELS[one.mode.value],
            name=f"{node}: vehicle {one.identity}",
            message=one.mode.value,
            hardware_id=hardware_id,
            values=key_values(scalars(one)),
        )
        for one in estimates
    ]
    return DiagnosticArray(header=header, status=status)


def markers_message(header: Header, estimates: Iterable[TrackEstimate]) -> MarkerArray:
    """Make box and number of each vehicle that is not lost, px as m; those before are deleted."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for one in estimates:
        if one.mode is not TrackMode.LOST:
            markers += [_outline(header, one), _number(header, one)]
    return MarkerArray(markers=markers)


def _outline(header: Header, estimate: TrackEstimate) -> Marker:
    marker = _marker(header, estimate, "box", Marker.LINE_STRIP)
    corners = estimate.box.corners
    marker.points = [Point(x=float(x), y=float(y)) for x, y in (*corners, corners[0])]
    marker.scale.x = _LINE_WIDTH
    return marker


def _number(header: Header, estimate: TrackEstimate) -> Marker:
    marker = _marker(header, estimate, "number", Marker.TEXT_VIEW_FACING)
    marker.pose.position.x = float(estimate.position[0])
    marker.pose.position.y = float(estimate.box.y)
    marker.scale.z = _LETTERS
    hidden = f" {estimate.mode.value}" if estimate.mode is TrackMode.OCCLUDED else ""
    marker.text = f"{estimate.identity} {estimate.label}".rstrip() + hidden
    return marker


def _marker(header: Header, estimate: TrackEstimate, namespace: str, kind: int) -> Marker:
    marker = Marker(header=header, ns=namespace, id=estimate.identity, type=kind, action=Marker.ADD)
    is_sure = estimate.mode is not TrackMode.TENTATIVE
    colour = identity_colour(estimate.identity) if is_sure else NEUTRAL
    marker.color.r, marker.color.g, marker.color.b = (part / 255 for part in colour)
    # Predicted boxes are faint.
    marker.color.a = 0.4 if estimate.mode is TrackMode.OCCLUDED else 1.0
    marker.pose.orientation.w = 1.0
    return marker
