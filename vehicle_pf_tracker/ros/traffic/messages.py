# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages about all vehicles of an image, and about lines and zones.

Detections come in and go out only where vision_msgs is installed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.ros.reading import read_message
from vehicle_pf_tracker.showing.drawing import NEUTRAL
from vehicle_pf_tracker.showing.traffic_drawing import identity_colour
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

MODE_CODES: Mapping[TrackMode, int] = MappingProxyType(
    {mode: code for code, mode in enumerate(TrackMode)}
)
"""Modes in `~/tracks`: 0 TENTATIVE, 1 TRACKING, 2 OCCLUDED, 3 LOST."""

_FLOATS = [(name, "<f4") for name in ("x", "y", "width", "height", "vx", "vy")]
_TRACK = np.dtype([("id", "<u4"), *_FLOATS, ("mode", "u1"), ("confidence", "<f4")], align=True)
"""A point of `~/tracks`, aligned, as C++ subscribers read it into a struct."""
_LINE_WIDTH = 2.0
"""Width of the lines of boxes in px: one is lost where RViz shows a large image small."""
_LETTERS = 14.0
"""Height of numbers in px: about that of the smallest vehicles that are followed."""
LONGEST_MESSAGE = 1_000_000
"""Longest message in bytes that is read: 2300 detections, which take rclpy 0.3 s. Ten thousand
would take 1.5 s, in which no image is answered."""


def tracks_message(
    header: Header, estimates: Sequence[TrackEstimate], frame_period: float
) -> PointCloud2:
    """Make the cloud with a point for each vehicle: centre and size in px, velocity in px/s."""
    points = np.zeros(len(estimates), _TRACK)
    for index, one in enumerate(estimates):
        box = one.box
        velocity = (part / frame_period for part in one.velocity)
        values = one.identity, *one.position, box.width, box.height, *velocity
        points[index] = *values, MODE_CODES[one.mode], one.confidence
    return messages.cloud_message(header, points)


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


def mode_statuses(estimates: Iterable[TrackEstimate]) -> Iterator[messages.Status]:
    """Describe each vehicle, with every scalar of its estimate."""
    for estimate in estimates:
        mode = estimate.mode.value
        yield (
            messages.LEVELS[mode],
            f"vehicle {estimate.identity or mode.lower()}",
            mode,
            scalars(estimate),
        )


def markers_message(header: Header, estimates: Iterable[TrackEstimate]) -> MarkerArray:
    """Make box and number of each vehicle that is not lost, px as m; those before are deleted."""
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for estimate in estimates:
        if estimate.mode is TrackMode.LOST:
            continue
        markers.append(_outline(header, estimate))
        if estimate.identity:  # a tentative one has no number
            markers.append(_number(header, estimate))
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
    marker = Marker(header=header, ns=namespace, id=estimate.serial, type=kind, action=Marker.ADD)
    is_sure = estimate.mode is not TrackMode.TENTATIVE
    colour = identity_colour(estimate.identity) if is_sure else NEUTRAL
    marker.color.r, marker.color.g, marker.color.b = (part / 255 for part in colour)
    # Predicted boxes are faint.
    marker.color.a = 0.4 if estimate.mode is TrackMode.OCCLUDED else 1.0
    marker.pose.orientation.w = 1.0
    return marker


def count_statuses(counter: Counter, latest: Mapping[str, Crossing]) -> Iterator[messages.Status]:
    """Describe each line and zone; `latest` has the last crossing of each place, by its name."""
    for place, names in counter.directions.items():
        values = _values(counter, place, names, latest.get(place))
        yield DiagnosticStatus.OK, place, _words(counter, place, names), values


def _words(counter: Counter, place: str, directions: tuple[str, str]) -> str:
    counts = ", ".join(f"{name} {counter.count(place, name)}" for name in directions)
    there = counter.occupancy.get(place)
    return counts if there is None else f"{there} inside, {counts}"


def _values(
    counter: Counter, place: str, directions: tuple[str, str], last: Crossing | None
) -> dict[str, object]:
    values: dict[str, object] = {name: counter.count(place, name) for name in directions}
    for (at, direction, label), number in sorted(counter.totals.items()):
        if at == place and label:
            values[f"{direction} {label}"] = number
    if place not in counter.occupancy:
        for name in directions:
            low, high = counter.interval(place, name)
            values[f"{name}, 90 % interval"] = f"{low} to {high}"
    if place in counter.occupancy:
        values["occupancy"] = counter.occupancy[place]
    if last is not None:
        values["last id"] = last.identity
        values["last direction"] = last.direction
        values["last stamp (ns)"] = last.stamp_ns
        speeds = {"last speed (px/s)": last.speed_px, "last speed (km/h)": last.speed_kmh}
        values |= {name: speed for name, speed in speeds.items() if speed is not None}
    return values


def detections_message(header: Header, estimates: Iterable[TrackEstimate]) -> Any:
    """Make the detections of the vehicles that are seen or predicted, with their numbers."""
    found = [
        messages.detection_message(
            header, estimate, str(estimate.identity), estimate.label or messages.CLASS
        )
        for estimate in estimates
        if estimate.mode in COUNTED_MODES
    ]
    return messages.detections_type()(header=header, detections=found)


def read_serialized_detections(message: bytes) -> Detections:
    """Read a vision_msgs/Detection2DArray in CDR, its encapsulation header included.

    A turned box becomes the upright one around it. Score and class are those of the hypothesis with
    the highest score; a detection without one has the score 1 and no class.

    Raises
    ------
    InputError
        If it is too long to be read in time, or no such message.
    """
    if len(message) > LONGEST_MESSAGE:
        raise InputError(
            f"a message of detections has {len(message) / 1e6:.1f} MB, more than the "
            f"{LONGEST_MESSAGE / 1e6:g} MB that are read; is the detector in order?"
        )
    found = read_message(message, messages.detections_type()).detections
    rows = [_row(one.bbox) for one in found]
    best = [_best(one.results) for one in found]
    boxes = np.array(rows, dtype=np.float64).reshape(-1, 5)
    with np.errstate(invalid="ignore", over="ignore"):
        x, y, width, height, theta = boxes.T
        cosine = np.abs(np.cos(theta))
        sine = np.abs(np.sin(theta))
        # Negative sizes stay so: they are to be refused, and a turn could make them positive.
        is_turned = (theta != 0) & (width > 0) & (height > 0)
        across = np.where(is_turned, width * cosine + height * sine, width)
        down = np.where(is_turned, width * sine + height * cosine, height)
        upright = np.stack([x - across / 2, y - down / 2, across, down], axis=1)
    return Detections.make(upright, [score for score, _ in best], [label for _, label in best])


def _row(box: Any) -> tuple[float, float, float, float, float]:
    centre = box.center
    at = centre.position
    return at.x, at.y, box.size_x, box.size_y, centre.theta


def _best(results: Any) -> tuple[float, str]:
    if not results:
        return 1.0, ""
    best = max((result.hypothesis for result in results), key=lambda one: float(one.score))
    return float(best.score), str(best.class_id)
