# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Where a hidden vehicle cannot be back, before moving and standing cameras."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.exclusion import exclusion_of, is_stranger
from vehicle_pf_tracker.trackers.fusion.hidden_way import HiddenWay
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting, Sightings
from vehicle_pf_tracker.trackers.fusion.state import State, Wholeness
from vehicle_pf_tracker.trackers.fusion.turning import Outlines
from vehicle_pf_tracker.trackers.fusion.verdict import Hidden, Visible

SIZE = np.array([20.0, 12.0])
LAST = np.array([100.0, 60.0])
AHEAD = LAST + np.array([30.0, 0.0])
VELOCITY = np.array([2.0, 0.0])


def driven():
    """Sightings of 12 frames to the right at 2 px per frame."""
    sightings = Sightings(camera_stood=0.0)
    for ago in range(11, -1, -1):
        sightings = sightings.moved_on(1.0, CameraMotion())
        sightings = sightings.added(LAST - ago * VELOCITY, SIZE, 1.0)
    return sightings


def hidden(visible=0.9, **more):
    velocities = np.tile(VELOCITY, (4, 1))
    particles = Hypotheses.around(np.tile(LAST, (4, 1)), velocities, np.zeros(4), visible)
    state = State(particles, LAST, SIZE, Wholeness.at_start(SIZE), Hidden(), sightings=driven())
    return state._replace(**more)


def step(*, stands, paint=1.0):
    """A step before a camera that stands or moves, in which each box has this share of paint."""
    foreground = SimpleNamespace(is_known=stands)
    appearance = SimpleNamespace(paint_share=lambda *_box: paint)
    memory = SimpleNamespace(foreground=foreground, appearance=appearance)
    return SimpleNamespace(memory=memory, frame=None)


def on_its_way():
    way = HiddenWay(Sighting(0.0, LAST, SIZE), PerspectiveMotion(LAST, VELOCITY, 0.0), 15.0)
    return Hidden(Outlines(way=way))


def test_before_a_moving_camera_what_is_behind_is_excluded():
    """It should have moved by its size, 15.5 px, and so a quarter of that, 3.9 px, at least."""
    positions = LAST + np.array([[3.0, 0.0], [5.0, 0.0], [90.0, 0.0]])
    state = hidden(sightings=driven().moved_on(10.0, CameraMotion()))
    excludes = exclusion_of(state, step(stands=False))
    assert excludes(positions).tolist() == [True, False, False]
    assert is_stranger(state, positions[0], step(stands=False))
    assert not is_stranger(state, positions[1], step(stands=False))


def test_where_the_camera_pans_it_is_behind_in_the_present_image():
    panned = driven().moved_on(10.0, CameraMotion(shift=np.array([50.0, 0.0])))
    excludes = exclusion_of(hidden(sightings=panned), step(stands=False))
    assert excludes(LAST + np.array([[53.0, 0.0], [55.0, 0.0]])).tolist() == [True, False]


@pytest.mark.parametrize(
    ("state", "stands"),
    [(hidden(verdict=Visible()), False), (hidden(sightings=Sightings()), False), (hidden(), True)],
    ids=["in view", "never seen clearly", "standing camera, no outlines"],
)
def test_else_nothing_is_excluded(state, stands):
    assert exclusion_of(state, step(stands=stands)) is None


def test_before_a_standing_camera_the_way_excludes():
    state = hidden(verdict=on_its_way())
    excludes = exclusion_of(state, step(stands=True))
    # Expected 30 px ahead: a size behind the last sighting it is not, nor two ahead of that.
    assert excludes(np.stack([LAST, AHEAD, AHEAD + 31.0])).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("paint", "visible", "is_another"),
    [(1.0, 0.9, False), (0.05, 0.9, True), (0.05, 0.4, False)],
    ids=["in its paint", "in another paint", "not believed to be back"],
)
def test_before_a_standing_camera_what_has_another_paint_is_a_stranger(paint, visible, is_another):
    state = hidden(visible, verdict=on_its_way())
    assert is_stranger(state, AHEAD, step(stands=True, paint=paint)) is is_another


def test_a_short_way_before_a_moving_camera_tells_nothing_of_what_is_behind():
    """Of half a size, 7.7 px: 6 px in three frames are less, 8 px in four are more."""
    ages = [driven().moved_on(elapsed, CameraMotion()) for elapsed in (3.0, 4.0)]
    found = [exclusion_of(hidden(sightings=each), step(stands=False)) for each in ages]
    assert found[0] is None and found[1] is not None
