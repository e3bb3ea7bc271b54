# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth of a recording: three messages for each frame, its position, its box and its occlusion."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.recordings.bags.messages import (
    DIAGNOSTIC_ARRAY,
    OK,
    POINT_STAMPED,
    POLYGON_STAMPED,
    WARN,
    diagnostic_array,
    point_stamped,
    polygon_stamped,
    stamp_ns,
)
from vehicle_pf_tracker.recordings.footage import LARGEST_PX

TRUTH_POSITION_TOPIC = "/ground_truth/position"
TRUTH_BOX_TOPIC = "/ground_truth/box"
TRUTH_MODE_TOPIC = "/ground_truth/mode"
TRUTH_TOPICS = (TRUTH_POSITION_TOPIC, TRUTH_BOX_TOPIC, TRUTH_MODE_TOPIC)

TRUTH_TYPES = {
    TRUTH_POSITION_TOPIC: POINT_STAMPED,
    TRUTH_BOX_TOPIC: POLYGON_STAMPED,
    TRUTH_MODE_TOPIC: DIAGNOSTIC_ARRAY,
}
"""The type of each truth topic."""


def truth_to_messages(truth: Truth) -> dict[str, Any]:
    """Make the messages that carry `truth`, by topic."""
    stamp = truth.stamp_ns
    name = truth.occlusion.name.lower()
    # NaN for "unknown": a diagnostic value is text, and a missing one may be an older recording.
    visible = math.nan if truth.visible_fraction is None else float(truth.visible_fraction)
    # A warning: that a vehicle is hidden is no error.
    level = WARN if truth.occlusion is Occlusion.TOTAL else OK
    values = {"occlusion": name, "visible_fraction": repr(visible)}
    return {
        TRUTH_POSITION_TOPIC: point_stamped(stamp, *truth.box.centre),
        TRUTH_BOX_TOPIC: polygon_stamped(stamp, truth.box.corners),
        TRUTH_MODE_TOPIC: diagnostic_array(stamp, "ground_truth", level, name, values),
    }


def truth_from_messages(
    received: Iterable[tuple[str, Any]], is_cut: bool = False
) -> tuple[Truth, ...]:
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
        frames[stamp_ns(message)][topic] = message
    # By stamp, since the three topics of a frame are three messages, which may be interleaved.
    stamps = sorted(frames)
    if is_cut and stamps:
        # With one stamp there is nothing to compare with but all the topics there are.
        complete = frames[stamps[0]].keys() if len(stamps) > 1 else TRUTH_TYPES.keys()
        if complete - frames[stamps[-1]].keys():
            stamps.pop()
    return tuple(_truth_of(stamp, frames[stamp]) for stamp in stamps)


def _truth_of(stamp_ns: int, by_topic: dict[str, Any]) -> Truth:
    if TRUTH_BOX_TOPIC not in by_topic:
        raise InputError(f"the truth at stamp {stamp_ns} ns has no box on {TRUTH_BOX_TOPIC}")
    box = _box_of(stamp_ns, by_topic)
    if TRUTH_MODE_TOPIC not in by_topic:
        return Truth(stamp_ns, box, Occlusion.NONE)
    occlusion, visible = _occlusion_of(stamp_ns, by_topic[TRUTH_MODE_TOPIC])
    return Truth(stamp_ns, box, occlusion, visible)


def _box_of(stamp_ns: int, by_topic: dict[str, Any]) -> Box:
    points = by_topic[TRUTH_BOX_TOPIC].polygon.points
    xs = [point.x for point in points]
    ys = [point.y for point in points]
    # Bounded, as a polygon is in single precision; see `LARGEST_PX`.
    if len(points) < 3 or not all(abs(side) <= LARGEST_PX for side in xs + ys):
        raise InputError(
            f"the truth box at stamp {stamp_ns} ns is not a polygon of corners within 2^24 px"
        )
    # The hull, whichever corner comes first, and whichever way round.
    width = max(xs) - min(xs)
    height = max(ys) - min(ys)
    if width <= 0 or height <= 0:
        raise InputError(f"the truth box at stamp {stamp_ns} ns has no area")
    # Corners are in single precision; the centre beside them has all digits.
    if TRUTH_POSITION_TOPIC not in by_topic:
        return Box(min(xs), min(ys), width, height)
    point = by_topic[TRUTH_POSITION_TOPIC].point
    if not (abs(point.x) <= LARGEST_PX and abs(point.y) <= LARGEST_PX):
        raise InputError(f"the truth position at stamp {stamp_ns} ns is not within 2^24 px")
    return Box.around((point.x, point.y), width, height)


def _occlusion_of(stamp_ns: int, message: Any) -> tuple[Occlusion, float | None]:
    values = {pair.key: pair.value for status in message.status for pair in status.values}
    try:
        occlusion = Occlusion[values["occlusion"].upper()]
        visible = float(values.get("visible_fraction", "nan"))
    except (KeyError, ValueError):
        raise InputError(
            f"the truth mode at stamp {stamp_ns} ns has no occlusion none, partial or total, "
            "or its visible_fraction is not a number"
        ) from None
    # Not finite: unknown.
    return occlusion, visible if math.isfinite(visible) else None
