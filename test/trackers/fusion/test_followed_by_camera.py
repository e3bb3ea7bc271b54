# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""How far a moving camera follows a vehicle, by how both guesses of where it goes have served."""

import numpy as np
import pytest
from fusion_samples import fusion, texture
from street import error, follow

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.fusion.followed_by_camera import Followed
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE, Sightings

LAG = 10.0
AGES = np.arange(30.0, -1.0, -1.0)
SIZE = np.array([30.0, 20.0])


def along(distances):
    """Positions (N, 2) at these distances along a heading of 3 to 4."""
    return np.outer(distances, [0.6, 0.8])


def share(on_road, in_image):
    return Followed.measured(AGES, along(on_road), along(in_image), LAG).share


def test_both_guesses_count_by_the_inverse_of_their_square_errors():
    """Braking by .01 px per frame squared is 1 px in ten frames, twice the .05 px per frame."""
    braking = 0.005 * AGES**2
    assert share(braking, 0.05 * AGES) == pytest.approx(1 / (1 + 0.5**2))
    assert share(braking, 0.1 * AGES) == pytest.approx(0.5)


def test_one_that_drives_evenly_on_the_road_is_expected_there():
    assert share(-2.0 * AGES, 0.05 * AGES) == pytest.approx(0)


def test_one_that_keeps_its_place_is_expected_there():
    assert share(0.005 * AGES**2, np.full(31, 7.0)) == pytest.approx(1)


def test_one_that_stands_while_the_camera_stands_has_no_errors():
    assert share(np.zeros(31), np.zeros(31)) == 0


def test_sightings_of_less_than_two_lags_tell_nothing():
    places = along(np.arange(20.0))
    few = Followed.measured(AGES[-20:], along(AGES[-20:] ** 2), places, LAG)
    assert few.share == 0
    assert few.place == pytest.approx([0.6 * 19, 0.8 * 19])


def test_between_two_sightings_it_was_between_their_places():
    """Every third frame is left out, and the frames a lag before are not all there."""
    some = np.arange(31) % 3 > 0
    braking = along(0.005 * AGES**2)[some]
    measured = Followed.measured(AGES[some], braking, along(0.1 * AGES)[some], LAG)
    assert measured.share == pytest.approx(0.5, abs=0.01)


def filmed(pan, drive, *, response=1.0):
    """Sightings of a vehicle that has driven so far in a frame's time, with a camera that pans."""
    sightings = Sightings()
    place = np.array([300.0, 200.0])
    for time in range(40):
        shift = np.array([-pan(time), 0.0])
        sightings = sightings.moved_on(1.0, CameraMotion(shift=shift))
        place = place + shift + [drive(time), 0.0]
        sightings = sightings.added(place, SIZE, response)
    return sightings


def uneven(time):
    return 4.0 + 2.0 * np.sin(time / 5)


def test_a_camera_that_pans_along_unevenly_follows_the_vehicle():
    followed = filmed(uneven, uneven).followed()
    assert followed.share == pytest.approx(1)
    assert followed.place == pytest.approx([300, 200])


def test_a_camera_that_pans_elsewhere_does_not():
    assert filmed(uneven, lambda _: 4.0).followed().share == pytest.approx(0)


def test_only_clear_sightings_count():
    assert filmed(uneven, uneven, response=CLEAR_RESPONSE - 0.01).followed() is None


def test_a_camera_that_stands_follows_none():
    assert filmed(lambda _: 0.0, uneven).followed() is None


def test_hypotheses_are_held_as_one():
    """Half of the way of their mean, at 20, to 10."""
    positions = np.array([[10.0, 0.0], [30.0, 0.0]])
    still = np.zeros((2, 2))
    particles = Hypotheses.around(positions, still, np.zeros(2), 0.1)
    held = particles.held(np.array([10.0, 4.0]), 0.5)
    assert held.positions == pytest.approx(np.array([[5.0, 2.0], [25.0, 2.0]]))
    assert held.velocities is particles.velocities


class Filmed:
    """A car that drives unevenly, and brakes while hidden, before a camera that pans along."""

    road, car = texture(5, 900, 240, 2.5, 5.0), texture(6, 60, 40, 2.5, 5.0)
    hidden = range(40, 70)
    left = np.cumsum([round(uneven(time)) if time < 40 else 1 for time in range(80)])

    def box(self, time):
        return Box(130.0, 100.0, 60.0, 40.0)

    def frame(self, time):
        left = self.left[time]
        picture = self.road[:, left : left + 320].copy()
        if time not in self.hidden:
            picture[100:140, 130:190] = self.car
        return picture


def test_a_hidden_vehicle_that_is_followed_is_expected_where_it_was_in_the_image():
    """Along the road it would be expected some 60 px ahead, at the speed that it had before."""
    tracker, filmed = fusion(), Filmed()
    estimates = follow(tracker, filmed, range(80))
    assert estimates[69].mode is Mode.OCCLUDED
    assert error(estimates[69], filmed, 69) < 20
    assert estimates[79].mode is Mode.TRACKING
    assert error(estimates[79], filmed, 79) < 3


def test_both_guesses_are_weighed_once_where_the_doubt_begins(monkeypatch):
    """No later frame tells more of them: what is carried along with the background only ages."""
    weighed = []
    whole = Sightings.followed

    def followed(sightings):
        weighed.append(whole(sightings))
        return weighed[-1]

    monkeypatch.setattr(Sightings, "followed", followed)
    tracker = fusion()
    follow(tracker, Filmed(), range(70))
    assert len(weighed) == 1
    assert weighed[0].share > 0.5
    assert tracker.state.verdict.followed is weighed[0]
