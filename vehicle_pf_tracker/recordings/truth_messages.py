"""Truth as ROS messages, and back."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.recordings import messages, topics

TYPES = {
    topics.TRUTH_POSITION_TOPIC: topics.POINT_STAMPED,
    topics.TRUTH_BOX_TOPIC: topics.POLYGON_STAMPED,
    topics.TRUTH_MODE_TOPIC: topics.DIAGNOSTIC_ARRAY,
}
"""The type of each truth topic."""


def to_messages(truth: Truth) -> dict[str, Any]:
    """Make the messages that carry `truth`, by topic."""
    stamp, name = truth.stamp_ns, truth.occlusion.name.lower()
    visible = math.nan if truth.visible_fraction is None else float(truth.visible_fraction)
    level = messages.WARN if truth.occlusion is Occlusion.TOTAL else messages.OK
    values = {"occlusion": name, "visible_fraction": repr(visible)}
    return {
        topics.TRUTH_POSITION_TOPIC: messages.point_stamped(stamp, *truth.box.centre),
        topics.TRUTH_BOX_TOPIC: messages.polygon_stamped(stamp, truth.box.corners),
        topics.TRUTH_MODE_TOPIC: messages.diagnostic_array(
            stamp, "ground_truth", level, name, values
        ),
    }


def from_messages(received: Iterable[tuple[str, Any]], is_cut: bool = False) -> tuple[Truth, ...]:
    """Assemble truth from (topic, message) pairs, by stamp and in the order of the stamps.

    The box gives the size, the position (double precision) the centre; a frame without a mode
    counts as not occluded. Where the recording is cut (`is_cut`) the last stamp counts only if it
    has all the topics that the first has, and the only one if it has all there are.

    Raises
    ------
    InputError
        If a stamp has no box, or a box or a mode cannot be understood.
    """
    frames: dict[int, dict[str, Any]] = defaultdict(dict)
    for topic, message in received:
        frames[messages.stamp_ns(message)][topic] = message
    stamps = sorted(frames)
    if is_cut and stamps:
        complete = frames[stamps[0]].keys() if len(stamps) > 1 else TYPES.keys()
        if complete - frames[stamps[-1]].keys():
            stamps.pop()
    return tuple(_assemble(stamp, frames[stamp]) for stamp in stamps)


def _assemble(stamp_ns: int, by_topic: dict[str, Any]) -> Truth:
    if topics.TRUTH_BOX_TOPIC not in by_topic:
        raise InputError(f"the truth at stamp {stamp_ns} ns has no box on {topics.TRUTH_BOX_TOPIC}")
    box = _box(stamp_ns, by_topic)
    if topics.TRUTH_MODE_TOPIC not in by_topic:
        return Truth(stamp_ns, box, Occlusion.NONE)
    occlusion, visible = _mode(stamp_ns, by_topic[topics.TRUTH_MODE_TOPIC])
    return Truth(stamp_ns, box, occlusion, visible)


def _box(stamp_ns: int, by_topic: dict[str, Any]) -> Box:
    points = by_topic[topics.TRUTH_BOX_TOPIC].polygon.points
    xs, ys = [point.x for point in points], [point.y for point in points]
    if len(points) < 3 or not all(map(math.isfinite, xs + ys)):
        raise InputError(f"the truth box at stamp {stamp_ns} ns is no polygon of finite corners")
    width, height = max(xs) - min(xs), max(ys) - min(ys)
    if width <= 0 or height <= 0:
        raise InputError(f"the truth box at stamp {stamp_ns} ns has no area")
    if topics.TRUTH_POSITION_TOPIC not in by_topic:
        return Box(min(xs), min(ys), width, height)
    point = by_topic[topics.TRUTH_POSITION_TOPIC].point
    if not (math.isfinite(point.x) and math.isfinite(point.y)):
        raise InputError(f"the truth position at stamp {stamp_ns} ns is not finite")
    return Box.around((point.x, point.y), width, height)


def _mode(stamp_ns: int, message: Any) -> tuple[Occlusion, float | None]:
    values = {pair.key: pair.value for status in message.status for pair in status.values}
    try:
        occlusion = Occlusion[values["occlusion"].upper()]
        visible = float(values.get("visible_fraction", "nan"))
    except (KeyError, ValueError):
        raise InputError(
            f"the truth mode at stamp {stamp_ns} ns has no occlusion none, partial or total, "
            "or its visible_fraction is no number"
        ) from None
    return occlusion, visible if math.isfinite(visible) else None
