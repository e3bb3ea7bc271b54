# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""New tracks, and those that go on at the border of the image."""

from dataclasses import replace

import numpy as np
import pytest
from measured_vehicle import BOX, SIZE
from traffic_samples import changed, step_of

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.births import begin_in_boxes, begin_tracks
from vehicle_pf_tracker.trackers.traffic.candidates import weigh
from vehicle_pf_tracker.trackers.traffic.state import Experience, State
from vehicle_pf_tracker.trackers.traffic.tracks import no_tracks

STEP = step_of(SIZE)
MEASUREMENT = STEP.measurement
AT_THE_BORDER = (0, 100, 40, 140)
LARGER = (0, 96, 48, 142)


def begin(waiting, shapes, *, are_shapes=True):
    """Tracks after the first of shapes began, where tracks of one detection each wait."""
    former = np.array(waiting, float)
    state = begin_in_boxes(State(no_tracks(), Experience()), former, STEP)
    tracks = changed(state.tracks, undetected=1.0, detection=former)
    beliefs = replace(tracks.beliefs, paths=tracks.beliefs.paths.added(former))
    tracks = replace(tracks, beliefs=beliefs)
    boxes = [(left, top, right - left, bottom - top) for left, top, right, bottom in shapes]
    detections = replace(Detections.make(boxes), are_shapes=are_shapes)
    evidence = state.experience.detections
    evidence.begin_image(are_shapes=are_shapes)
    candidates = weigh(detections, evidence, SIZE)
    return begin_tracks(state._replace(tracks=tracks), candidates, np.array([0]), STEP).tracks


def test_a_vehicle_that_the_border_cuts_goes_on_from_its_former_track():
    tracks = begin([AT_THE_BORDER], [LARGER])
    assert tracks.names.serial.tolist() == [1]
    # With the way of before, and the shape of now.
    assert tracks.beliefs.paths.matches.tolist() == [2]
    assert tracks.beliefs.paths.first.tolist() == [list(AT_THE_BORDER)]
    assert tracks.latest.detection.tolist() == [list(LARGER)]
    assert tracks.detected.all()


@pytest.mark.parametrize(
    ("former", "shapes", "are_shapes"),
    [
        (AT_THE_BORDER, [LARGER], False),  # a network's boxes are whole
        (AT_THE_BORDER, [(0, 160, 40, 200)], True),  # elsewhere
        (AT_THE_BORDER, [LARGER, (50, 96, 90, 142)], True),  # a piece, with its rest
        (BOX, [(100, 96, 148, 132)], True),  # nothing cuts it
        (AT_THE_BORDER, [(8, 100, 48, 140)], True),  # nothing cuts it any more
        ((100, 200, 140, 240), [(98, 190, 144, 240)], True),  # the lower border cuts it
    ],
)
def test_other_shapes_begin_tracks_of_their_own(former, shapes, are_shapes):
    tracks = begin([former], shapes, are_shapes=are_shapes)
    assert tracks.names.serial.tolist() == [1, 2]
    assert tracks.beliefs.paths.matches.tolist() == [1, 1]


def test_of_two_tracks_the_nearer_one_goes_on():
    tracks = begin([AT_THE_BORDER, (0, 104, 46, 144)], [(0, 105, 48, 145)])
    # The first one waits on, the second has the shape.
    assert tracks.names.serial.tolist() == [1, 2]
    assert tracks.detected.tolist() == [False, True]
