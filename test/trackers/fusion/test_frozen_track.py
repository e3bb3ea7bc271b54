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

"""The frozen track: which return is undone, by responses that are given."""

from dataclasses import replace

import numpy as np
import pytest

from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.canonical_patch import Patch
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.frozen_track import FrozenTrack
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.parameters import VisibilityParameters
from vehicle_pf_tracker.trackers.fusion.perspective import Sightings

SIZE = np.array([40.0, 40.0])
CENTRE = np.array([100.0, 80.0])
STILL = CameraMotion()


class Answers:
    """Stands in for an appearance: answers with given heights at given offsets from the middle."""

    def __init__(self, peaks):
        self.peaks = peaks

    def twin(self):
        return Answers(dict(self.peaks))

    def patch(self, _frame, position, size, *, wide=False):
        side = 256 if wide else 128
        blank = np.zeros((side, side), np.uint8)
        return Patch(np.dstack([blank] * 3), blank, position, 40.0 / size)

    def view(self, patch):
        response = np.zeros((patch.side // 2, patch.side // 2), np.float32)
        for (x, y), height in self.peaks.items():
            column, row = x // 2 + len(response) // 2, y // 2 + len(response) // 2
            response[row, column] = height
        return View(patch, None, response)


def frozen(peaks, spread=10.0):
    """A vehicle that is predicted at `CENTRE`, known to `spread` px, and was taken to return."""
    draws = np.random.default_rng(0).normal(size=(400, 2)) * spread
    positions = CENTRE + draws - draws.mean(axis=0)
    cloud = Hypotheses.around(positions, np.zeros((400, 2)), np.zeros(400), 0.02)
    track = FrozenTrack(Answers(peaks), Sightings(), cloud, SIZE)
    track.take_return(Answers(peaks), Sightings())
    return track


def looks(track, offset, times=3):
    """Places that are found for a return this far from the prediction."""
    position, parameters = CENTRE + offset, VisibilityParameters()
    return [track.likelier_place(None, position, np.ones(2), parameters) for _ in range(times)]


def test_a_clear_answer_on_the_path_is_preferred_from_its_second_frame_on():
    """0.65 at three standard deviations: 12 * 0.15 - 4.5; 1.0 on the path: 12 * 0.5."""
    first, second, _ = looks(frozen({(0, 0): 1.0, (30, 0): 0.65}), (30, 0))
    assert first is None
    view, place = second
    assert place == pytest.approx(CENTRE, abs=1)
    assert view.at(place) == pytest.approx(1.0)


def test_a_weak_answer_elsewhere_changes_nothing():
    """0.74 is not clear, however unlikely the return is."""
    assert looks(frozen({(0, 0): 0.74, (30, 0): 0.1}), (30, 0)) == [None] * 3


def test_an_equal_answer_farther_from_the_path_changes_nothing():
    assert looks(frozen({(0, 0): 0.9, (30, 0): 1.0}), (0, 0)) == [None] * 3


def test_the_same_vehicle_is_no_other_place():
    """15 px are less than half of the vehicle's size."""
    assert looks(frozen({(0, 0): 1.0, (14, 0): 0.3}), (14, 0)) == [None] * 3


def test_a_return_out_of_the_prediction_s_reach_loses_to_any_clear_answer():
    assert looks(frozen({(0, 0): 0.8}), (300, 0))[1] is not None


def test_the_longer_since_the_return_the_clearer_has_another_place_to_be():
    """4.8 to 2.4: 1.5 are enough at once, and 1.5 + 25 * 0.051 asked after 25 frames unseen."""
    peaks = {(0, 0): 0.9, (20, 0): 0.7}
    assert looks(frozen(peaks, spread=100.0), (20, 0))[1] is not None
    later = frozen(peaks, spread=100.0)
    later.pass_time(25.0, STILL)
    assert looks(later, (20, 0)) == [None] * 3


def test_a_return_is_compared_for_thirty_frames():
    track = frozen({})
    track.pass_time(29.0, STILL)
    assert not track.is_over
    track.pass_time(2.0, STILL)
    assert track.is_over
    track.take_return(track.appearance, track.sightings)
    assert not track.is_over


def test_sightings_of_before_stay_and_age_with_the_return():
    track, sightings = frozen({}), Sightings()
    sightings.add(CENTRE, SIZE, 1.0)
    track.take_return(track.appearance, sightings)
    sightings.add(CENTRE + 50, SIZE, 1.0)
    track.pass_time(3.0, STILL)
    assert len(track.sightings) == 1
    assert track.sightings.fit(perspective=True)[1].age == 3.0


def test_it_drives_on_and_grows_without_being_weighed():
    cloud = Hypotheses.around(np.array([CENTRE]), np.array([[2.0, 0.0]]), np.array([0.01]), 0.02)
    track = FrozenTrack(Answers({}), Sightings(), cloud, SIZE)
    track.drive(np.random.default_rng(0), 1.0, (0.0, 0.0))
    assert track.size == pytest.approx(SIZE * np.exp(0.01))
    assert track.particles.mean == pytest.approx([CENTRE[0] + 2 * np.exp(0.02), 80])
    track.pass_time(1.0, CameraMotion(np.eye(2), np.array([5.0, -3.0])))
    assert track.particles.mean == pytest.approx([CENTRE[0] + 2 * np.exp(0.02) + 5, 77])


def test_a_hidden_vehicle_grows_threefold_at_most():
    track, rng = frozen({}), np.random.default_rng(0)
    track.particles = replace(track.particles, growths=np.full(400, 0.02))
    for _ in range(10):
        track.drive(rng, 1.0, (0.0, 0.0))
    assert track.size[0] == pytest.approx(SIZE[0] * np.exp(0.02 * 10), rel=0.03)
    for _ in range(100):
        track.drive(rng, 1.0, (0.0, 0.0))
    assert track.size == pytest.approx(3 * SIZE)
