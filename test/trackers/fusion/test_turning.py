# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The turning branch: rectangles that turn, are cut by a wall, or run into another one."""

import math

import numpy as np
import pytest
from fusion_samples import grey_road

from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.motion.foreground import Foreground, Outline
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting
from vehicle_pf_tracker.trackers.fusion.turning import Branch, Outlines

SIZE = np.array([26.0, 16.0])
SPEED = 2.0
START = np.array([30.0, 100.0])
DOUBT = 40
"""Frame in which the doubt begins; the turn begins with it."""


ROAD = grey_road(240, 160)


def view(response):
    """Every place has the same response."""
    blank = np.zeros((8, 8), np.uint8)
    patch = Patch(np.dstack([blank] * 3), blank, START, np.ones(2))
    return View(patch, None, np.full((8, 8), response, np.float32))


def path(turns):
    """Centres by frame: straight, then to the left by `turns` rad per frame."""
    centre, heading, centres = START.copy(), 0.0, []
    for time in range(80):
        centres.append(centre.copy())
        heading -= turns if time >= DOUBT else 0.0
        centre = centre + SPEED * np.array([math.cos(heading), math.sin(heading)])
    return centres


def drive(
    turns,
    paint=lambda picture, time: None,
    response=0.1,
    stands=lambda time: True,
    late=0,
    difference=1.0,
):
    """Run the branch from the doubt on; what it gives, frame by frame, and the true centres.

    The doubt begins `late` frames after the turn, with the last clear sighting before it.
    """
    turning, foreground, centres, given = Outlines(), Foreground(), path(turns), []
    for time, centre in enumerate(centres):
        picture = ROAD.copy()
        left, top = np.rint(centre - SIZE / 2).astype(int)
        picture[top : top + 16, left : left + 26] = 230
        paint(picture, time)
        foreground.keep(SmallGrey(picture, 1.0), stands=stands(time))
        if not foreground.is_known:
            turning = Outlines()
        if time > DOUBT + late:
            turning = turning.followed(foreground, 1.0, view(response), lambda *_: difference)
            given.append(turning.vehicle)
        elif time == DOUBT + late:
            if foreground.is_known:
                foreground.learn_background()
            motion = PerspectiveMotion(centres[DOUBT], np.array([SPEED, 0.0]), 0.0)
            last = Sighting(late, centres[DOUBT], SIZE)
            turning = Outlines.begun(foreground, motion, last)
    return given, centres[DOUBT + late + 1 :]


def test_a_vehicle_that_turns_is_followed_by_its_outline():
    given, centres = drive(turns=0.08)
    first = next(i for i, turned in enumerate(given) if turned)
    assert first < 16
    for turned, centre in list(zip(given, centres, strict=True))[first : first + 10]:
        assert turned.box[0] == pytest.approx(centre, abs=1.5)
        assert turned.box[1] == pytest.approx(SIZE, abs=2.5)
    assert given[first + 5].velocity[1] < -0.5


def test_a_turn_that_the_doubt_comes_late_for_is_proven_at_once():
    assert drive(turns=0.08, late=11)[0][0] is not None
    assert drive(turns=0.04, late=20)[0][0] is not None


def test_a_shadow_keeps_its_extent_while_the_vehicle_turns():
    """The outline has 6 px of shadow on the right and 4 px below, lying and upright."""
    lying, upright = np.array([26.0, 16.0]), np.array([16.0, 26.0])
    shadow, low = np.array([6.0, 4.0]), np.array([50.0, 40.0])
    motion = PerspectiveMotion(low, np.zeros(2), 0.0)
    outline = Outline(low, low + upright + shadow)
    branch = Branch(motion, lying, (np.zeros(2), shadow), outline, np.zeros(2))
    centre, size = branch.box
    assert size == pytest.approx(upright)
    assert centre == pytest.approx(low + upright / 2)


def wall(picture, _time):
    picture[:, 140:] = ROAD[:, 140:]  # hides what is behind


def lorry(picture, time):
    """It comes from behind, and merges with the vehicle six frames after the doubt began."""
    right = int(START[0] + SPEED * DOUBT - 13 + 4 * (time - DOUBT - 6) + 2 * 6)
    picture[70:112, max(right - 90, 0) : max(right, 0)] = 200


@pytest.mark.parametrize(
    "options",
    [
        {"turns": 0.0}, {"turns": 0.0, "paint": wall}, {"turns": 0.0, "paint": lorry},
        {"turns": 0.08, "stands": lambda time: time != DOUBT + 1},
        {"turns": 0.08, "difference": 1.1}, {"turns": 0.04, "difference": 1.1, "late": 20},
    ],
    ids=[
        "straight on", "cut by a wall", "run into by a lorry", "moving camera", "in another paint",
        "in another paint when the doubt begins",
    ],
)  # fmt: skip
def test_what_does_not_leave_its_path_or_cannot_be_told_is_no_turn(options):
    assert not any(drive(**options)[0])


@pytest.mark.parametrize(("behind", "is_proven"), [(9.0, True), (11.0, False)])
def test_what_is_behind_the_path_by_more_than_half_a_size_is_no_turn(behind, is_proven):
    """Half of the size is 10.2 px; the outline is beside the path, and moves away from it."""

    class Seen:
        """Give the outlines of a vehicle that is `behind`, a px farther aside in each frame."""

        def outline(self, _centre, _size, _ago):
            time = branch.age + 1.0
            centre = START + np.array([SPEED * time - behind, 20.0 + time])
            return Outline(centre - SIZE / 2, centre + SIZE / 2)

    first = START + np.array([-behind, 20.0])
    outline = Outline(first - SIZE / 2, first + SIZE / 2)
    motion = PerspectiveMotion(START, np.array([SPEED, 0.0]), 0.0)
    branch = Branch(motion, SIZE, (np.zeros(2), np.zeros(2)), outline, np.array([SPEED, 1.0]))
    for _ in range(4):
        branch = branch.moved(Seen(), 1.0)
    assert branch.is_proven == is_proven


def test_the_turn_is_over_when_the_filter_knows_the_vehicle_again():
    given = [turned is not None for turned in drive(turns=0.08, response=0.9)[0]]
    # In the eighth frame in a row in which the filter knows it, the one of the proof included.
    assert sum(given) == PROOF_FRAMES - 1
    assert not any(given[given.index(True) + PROOF_FRAMES - 1 :])


def test_the_turn_goes_on_while_the_outline_still_changes_its_shape():
    """The filter knows each side as it comes; the vehicle becomes narrower for 24 frames."""
    motion = PerspectiveMotion(START, np.zeros(2), 0.0)
    margins = (np.zeros(2), np.zeros(2))
    outline = Outline(START, START + SIZE)
    branch = Branch(motion, SIZE, margins, outline, np.zeros(2), is_proven=True)
    for time in range(24):
        size = SIZE - (time / 2, 0)
        branch = branch._replace(outline=Outline(START, START + size)).judged(view(0.9))
        assert not branch.is_over
    # Coming near or going away changes the size, and not the shape.
    for time in range(PROOF_FRAMES):
        branch = branch._replace(outline=Outline(START, START + size * 1.05**time))
        branch = branch.judged(view(0.9))
    assert branch.is_over
    # An outline of a few px never keeps its shape: after 40 frames the filter alone decides.
    branch = branch._replace(age=41.0, clear=0)
    for time in range(PROOF_FRAMES):
        wide = SIZE + np.array([4.0 * (time % 2), 0.0])
        branch = branch._replace(outline=Outline(START, START + wide)).judged(view(0.9))
    assert branch.is_over


def test_frames_that_were_dropped_are_not_counted_back():
    """Before the doubt every second frame is missing: ten periods are five frames."""
    foreground = Foreground()
    centres = [START + np.array([SPEED * time, 0.0]) for time in range(0, 60, 2)]
    for centre in centres:
        picture = ROAD.copy()
        left, top = np.rint(centre - SIZE / 2).astype(int)
        picture[top : top + 16, left : left + 26] = 230
        foreground.keep(SmallGrey(picture, 1.0), stands=True, elapsed=2.0)
    motion = PerspectiveMotion(centres[-6], np.array([SPEED, 0.0]), 0.0)
    branch = Branch.begun(foreground, motion, Sighting(10.0, centres[-6], SIZE))
    assert branch.age == 10.0
    assert branch.box[0] == pytest.approx(centres[-1], abs=1.5)
    assert branch.velocity == pytest.approx([SPEED, 0.0], abs=0.2)
    assert Branch.begun(foreground, motion, Sighting(50.0, centres[-6], SIZE)) is None


def test_frames_of_another_size_begin_anew():
    foreground = Foreground()
    for time in range(60):
        picture = ROAD if time < 59 else ROAD[:100]
        assert foreground.is_known is (time > 20)
        foreground.keep(SmallGrey(picture, 1.0), stands=True)
    assert not foreground.is_known
    motion = PerspectiveMotion(START, np.array([SPEED, 0.0]), 0.0)
    last = Sighting(0.0, START, SIZE)
    assert Outlines.begun(foreground, motion, last) == Outlines()
