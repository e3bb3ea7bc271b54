# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Annotations for Foxglove: what is drawn in each mode, and where."""

import pytest

from vehicle_pf_tracker.recordings.bags.messages import (
    IMAGE_ANNOTATIONS,
    definition,
    deserialize,
    serialize,
)
from vehicle_pf_tracker.results.estimates import WAITING_MODE, EstimateRow
from vehicle_pf_tracker.showing.estimates_recording import (
    LINE_LIST,
    LINE_LOOP,
    image_annotations,
)
from vehicle_pf_tracker.showing.target_drawing import MODE_COLOURS

STAMP = 3_000_000_007


def row(mode="TRACKING", x=50.0):
    return EstimateRow(1, STAMP, x, 30.0, 20.0, 12.0, mode, 0.5, 99.0, 1.0)


def annotated(row, name="", size=(640, 360)):
    """Return the message as it is read back."""
    message = image_annotations(name, row, size)
    return deserialize(serialize(message, IMAGE_ANNOTATIONS), IMAGE_ANNOTATIONS)


def points(line):
    return [(point.x, point.y) for point in line.points]


def rgb(colour):
    return tuple(round(255 * value) for value in (colour.r, colour.g, colour.b))


def test_a_tracked_vehicle_has_its_box_and_words():
    message = annotated(row(), name="van")
    (box,), (words,) = message.points, message.texts
    assert box.type == LINE_LOOP
    assert points(box) == [(40.0, 24.0), (60.0, 24.0), (60.0, 36.0), (40.0, 36.0)]
    assert rgb(box.outline_color) == MODE_COLOURS["TRACKING"]
    assert (box.outline_color.a, box.fill_color.a) == (1.0, 0.0)
    assert words.text == "van TRACKING 0.50"
    assert rgb(words.text_color) == MODE_COLOURS["TRACKING"]
    assert (words.position.x, words.position.y) == (40.0, 22.0)  # on the box


def test_a_predicted_box_is_dashed():
    (box,) = annotated(row("OCCLUDED")).points
    assert box.type == LINE_LIST
    assert rgb(box.outline_color) == MODE_COLOURS["OCCLUDED"]
    ends = points(box)
    # sides of 20 and 12 px in dashes and gaps of 4 px: 3 and 2 dashes
    assert ends[:6] == [(40, 24), (44, 24), (48, 24), (52, 24), (56, 24), (60, 24)]
    assert ends[6:10] == [(60, 24), (60, 28), (60, 32), (60, 36)]
    assert len(ends) == 2 * (3 + 2 + 3 + 2)


@pytest.mark.parametrize("one", [row("LOST"), EstimateRow.without(2, STAMP, WAITING_MODE)])
def test_without_a_claim_nothing_is_drawn(one):
    message = annotated(one)
    assert not (message.points or message.texts)


def test_every_part_has_the_stamp_of_its_image():
    message = annotated(row())
    parts = [*message.points, *message.texts]
    assert len(parts) == 2
    assert {(one.timestamp.sec, one.timestamp.nanosec) for one in parts} == {(3, 7)}


def test_lines_and_letters_grow_with_the_image():
    small, large = annotated(row()), annotated(row(), size=(3840, 2160))
    assert (small.points[0].thickness, large.points[0].thickness) == (1.0, 7.0)
    assert large.texts[0].font_size == 7 * small.texts[0].font_size


def test_words_of_a_box_at_the_edge_stay_in_the_image():
    (words,) = annotated(row(x=5.0), size=(640, 360)).texts
    assert words.position.x == 0.0
    high = EstimateRow(1, STAMP, 50.0, 4.0, 20.0, 12.0, "TRACKING", 0.5, 99.0, 1.0)
    (words,) = annotated(high).texts
    assert words.position.y == words.font_size


def test_the_definition_names_everything_that_it_is_made_of():
    text = definition(IMAGE_ANNOTATIONS)
    parts = {part.splitlines()[0] for part in text.split("MSG: ")[1:]}
    names = ("CircleAnnotation", "PointsAnnotation", "TextAnnotation", "Point2", "Color")
    assert parts == {"builtin_interfaces/Time", *(f"foxglove_msgs/{name}" for name in names)}
