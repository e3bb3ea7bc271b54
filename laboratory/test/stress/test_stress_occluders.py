# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Painted occluders hide what their truth says they hide, in the picture itself."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stress_samples import RED, box_of, red_share, turning_course, write_sequence

from laboratory.stress import find_sequences, list_cases
from laboratory.stress.background import background_of
from laboratory.stress.coverage import visible_share
from laboratory.stress.footage import open_footage
from laboratory.stress.occluder import Motion, Occluder
from laboratory.stress.painting import Texture
from laboratory.stress.placing import course_of
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth

WALL = Texture("wall", 1, 0, (0, 0, 40, 40))


def of_kinds(cases, *kinds):
    return [case for case in cases if case.kind in kinds]


def test_a_painted_wall_hides_exactly_the_frames_it_should(drive):
    # The vehicle is 20 px wide and its left edge at round(8 + 1.5 i): behind the wall from x = 80
    # to 130 it is wholly from left edge 80 to 110, and for less than a tenth in view from 79 to 111
    # (one of 20 px outside), touched from left edge 61 to 129.
    wall = Occluder(Box(80, 20, 50, 50), Motion(0), WALL)
    paint = wall.painter(open_footage(drive.source), 0)
    for index in range(100):
        box = box_of(index)
        truth = wall.truth(Truth(0, box, Occlusion.NONE), index, (256, 96), 0)
        expected = Occlusion.NONE
        if 61 <= box.x <= 129:
            expected = Occlusion.TOTAL if 79 <= box.x <= 111 else Occlusion.PARTIAL
        assert truth.occlusion is expected, index
        frame = paint(open_footage(drive.source).frame(index), index)
        assert red_share(frame, box) == pytest.approx(truth.visible_fraction or 1.0, abs=1e-6) or (
            truth.visible_fraction == 0.0 and red_share(frame, box) == 0.0
        )


@pytest.mark.parametrize("kind", ["wall", "pole", "lorry"])
def test_the_truth_of_placed_occluders_is_what_the_picture_shows(battery, kind):
    cases = of_kinds(battery, kind)
    assert len(cases) >= (1 if kind == "pole" else 3)
    for case in cases:
        hidden = 0
        for frame, _, truth in case.play():
            seen = red_share(frame, truth.box)
            share = 1.0 if truth.visible_fraction is None else truth.visible_fraction
            # Half-covered pixels at the edges are red or not.
            assert abs(seen - share) < 0.09, case.name
            hidden += truth.occlusion is Occlusion.TOTAL
        assert hidden == int(case.label("hidden"))
        if kind == "pole":
            assert hidden == 0
        else:
            wanted = int(case.variation.rpartition("_")[0].rpartition("_")[2])
            assert abs(hidden - wanted) <= max(1, wanted / 4)


def test_occlusions_can_be_judged_and_begin_in_full_view(battery):
    for case in of_kinds(battery, "wall", "lorry"):
        occlusions = [truth.occlusion for truth in case.truths()]
        last = max(i for i, each in enumerate(occlusions) if each is Occlusion.TOTAL)
        assert len(occlusions) - 1 - last >= 20
        assert occlusions[:8] == [Occlusion.NONE] * 8
        assert case.label("carried_by") == "standing camera"


def test_straight_and_turning_stretches_are_told_apart(tmp_path, battery):
    write_sequence(tmp_path / "bend", way=turning_course)
    cases = list_cases(find_sequences(tmp_path), kinds=["wall", "lorry"])
    corner = 60
    labels = {case.label("path") for case in cases}
    assert "turning" in labels
    for case in cases:
        hidden = [i for i, t in enumerate(case.truths()) if t.occlusion is Occlusion.TOTAL]
        entry, leaving = case.first + hidden[0], case.first + hidden[-1]
        if case.label("path") == "turning":
            assert entry - 15 < corner < leaving + 15
        if entry < corner - 2 and leaving > corner + 10:
            assert case.label("path") == "turning"
    straight = of_kinds(battery, "wall", "lorry", "pole")
    assert {case.label("path") for case in straight} == {"straight"}
    assert {case.label("course") for case in straight} == {"across"}  # of one size all the time
    assert all(
        case.label("course") == "turning" for case in cases if case.label("path") == "turning"
    )


def test_a_vehicle_comes_near_by_a_tenth_of_its_size():
    first = Box(0, 0, 40, 20)
    assert course_of(first, Box(90, 50, 44.1, 22)) == "coming near"
    assert course_of(first, Box(90, 50, 44, 21.9)) == "across"
    assert course_of(first, Box(90, 50, 40 / 1.1, 20 / 1.11)) == "going away"
    assert course_of(first, Box(90, 50, 20, 40)) == "across"  # another side of the same area


def test_a_standing_wall_moves_with_the_background_of_a_panning_camera(tmp_path):
    # The camera pans by 2 px to the right in each frame: what stands moves left by 2 px.
    write_sequence(tmp_path / "pan", pan=2)
    (source,) = find_sequences(tmp_path)
    background = background_of(source.source)
    assert (background.stands, background.coherent) == (False, True)
    cases = list_cases([source], kinds=["wall"])
    assert cases
    for case in cases:
        assert case.label("carried_by") == "background"
        (wall,) = case.changes
        first, later = case.first, case.first + 20
        moved = wall.corners(later) - wall.corners(first)
        assert np.abs(moved - (-40.0, 0.0)).max() < 1.0


def test_a_still_camera_is_recognised(drive):
    background = background_of(drive.source)
    assert background.stands
    assert (background.from_first == np.eye(3)).all()


def test_what_the_sequence_hides_itself_stays_hidden():
    wall = Occluder(Box(0, 0, 10, 10), Motion(0), WALL)
    for own in (Occlusion.PARTIAL, Occlusion.TOTAL):
        beside = Truth(0, Box(40, 40, 10, 10), own)
        assert wall.truth(beside, 0, (100, 100), 0) == beside
        half = wall.truth(Truth(0, Box(5, 0, 10, 10), own), 0, (100, 100), 0)
        assert (half.occlusion, half.visible_fraction) == (own, None)


def rectangle(x, y, width, height, angle=0.0, centre=(50.0, 50.0)):
    corners = np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return (corners - centre) @ turn + centre


@given(
    st.floats(0, 60), st.floats(0, 60), st.floats(2, 30), st.floats(2, 30), st.floats(-20, 80),
    st.floats(1.5, 60),
)  # fmt: skip
def test_the_visible_share_is_that_of_the_areas(x, y, width, height, left, wide):
    hidden = max(0.0, min(x + width, left + wide) - max(x, left)) / width
    share = visible_share(rectangle(left, -10, wide, 200), Box(x, y, width, height), (100, 100))
    # Where an edge of the box and one of the occluder are in one pixel, their order is not known.
    assert share == pytest.approx(1 - hidden, abs=0.51 / width)


def test_only_the_part_in_the_image_counts():
    half_outside = Box(-10, 0, 20, 10)
    assert visible_share(rectangle(0, 0, 5, 10), half_outside, (50, 50)) == pytest.approx(0.5)
    assert visible_share(rectangle(0, 0, 5, 10), Box(-30, 0, 20, 10), (50, 50)) == 1.0


def test_occluders_are_textured_and_grey_in_grey_footage(tmp_path, drive, battery):
    case = of_kinds(battery, "lorry")[0]
    (lorry,) = case.changes
    footage = open_footage(drive.source)
    texture = lorry.texture.make(footage, lorry.rectangle)
    assert texture.std() > 5
    assert texture.std(axis=2).max() > 1  # coloured, since the vehicle is red
    folder = write_sequence(tmp_path / "grey")
    for path in (folder / "img").iterdir():
        grey = _grey(path)
        assert not (grey == RED).all(axis=2).any()
    (source,) = find_sequences(folder)
    grey = open_footage(source.source)
    assert grey.is_grey
    assert lorry.texture.make(grey, lorry.rectangle).std(axis=2).max() < 1e-3


def _grey(path):
    image = cv2.cvtColor(cv2.imread(str(path)), cv2.COLOR_BGR2GRAY)
    cv2.imwrite(str(path), image)
    return image[..., np.newaxis].repeat(3, axis=2)
