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

"""Annotations for Foxglove: what is drawn in each mode, and where."""

import pytest

from vehicle_pf_tracker.offline.drawing import COLOURS, NEUTRAL
from vehicle_pf_tracker.offline.estimates import WAITING, EstimateRow
from vehicle_pf_tracker.offline.estimates_recording import (
    LINE_LIST,
    LINE_LOOP,
    LINE_STRIP,
    ImageAnnotator,
)
from vehicle_pf_tracker.recordings.messages import (
    IMAGE_ANNOTATIONS,
    definition,
    deserialize,
    serialize,
)

STAMP = 3_000_000_007


def row(mode="TRACKING", x=50.0, number=1, stamp=STAMP):
    return EstimateRow(number, stamp, x, 30.0, 20.0, 12.0, mode, 0.5, 99.0, 1.0)


def annotated(*rows, name="", size=(640, 360), position=0):
    """Return the message of the last row, as it is read back."""
    annotator = ImageAnnotator(name, size, position)
    message = [annotator.annotate(one) for one in rows][-1]
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
    assert rgb(box.outline_color) == COLOURS["TRACKING"]
    assert (box.outline_color.a, box.fill_color.a) == (1.0, 0.0)
    assert words.text == "van TRACKING 0.50"
    assert rgb(words.text_color) == COLOURS["TRACKING"]
    assert (words.position.x, words.position.y) == (40.0, 22.0)  # on the box


def test_the_path_grows_and_stays_short():
    rows = [row(x=50.0 + n) for n in range(100)]
    _, path = annotated(*rows[:3]).points
    assert (path.type, points(path)) == (LINE_STRIP, [(50.0, 30.0), (51.0, 30.0), (52.0, 30.0)])
    _, path = annotated(*rows).points
    assert points(path) == [(90.0 + n, 30.0) for n in range(60)]


def test_a_predicted_box_is_dashed():
    (box,) = annotated(row("OCCLUDED")).points
    assert box.type == LINE_LIST
    assert rgb(box.outline_color) == COLOURS["OCCLUDED"]
    ends = points(box)
    # sides of 20 and 12 px in dashes and gaps of 4 px: 3 and 2 dashes
    assert ends[:6] == [(40, 24), (44, 24), (48, 24), (52, 24), (56, 24), (60, 24)]
    assert ends[6:10] == [(60, 24), (60, 28), (60, 32), (60, 36)]
    assert len(ends) == 2 * (3 + 2 + 3 + 2)


@pytest.mark.parametrize(
    ("last", "text", "colour"),
    [
        (row("LOST"), "LOST 0.50", COLOURS["LOST"]),
        (EstimateRow.without(2, STAMP, WAITING), "WAITING", NEUTRAL),
    ],
)
def test_without_a_claim_there_are_words_only_and_the_path_ends(last, text, colour):
    message = annotated(row(), last, position=1)
    (words,) = message.texts
    assert (len(message.points), words.text, rgb(words.text_color)) == (0, text, colour)
    assert (words.position.x, words.position.y) == (6.0, 36.0)  # the second line of the corner
    assert len(annotated(row(), last, row()).points) == 1


def test_every_part_has_the_stamp_of_its_image():
    message = annotated(row(), row())
    parts = [*message.points, *message.texts]
    assert len(parts) == 3
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
