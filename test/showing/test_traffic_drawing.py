# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles and counts drawn into images."""

import cv2
import numpy as np
import pytest
from traffic_samples import vehicle

from vehicle_pf_tracker.core.box import Box, intersections
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan, CountingZone
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.drawing import draw_box, write_labels
from vehicle_pf_tracker.showing.grids import draw_pixel_grid
from vehicle_pf_tracker.showing.traffic_drawing import (
    Trails,
    draw_vehicle,
    frame_with_vehicles,
    identity_colour,
)
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

BLACK = np.zeros((240, 320, 3), np.uint8)
# The box of `vehicle(…, 160, 200, size=(100, 80))`: 110 to 210 across, 120 to 200 down.


def drawn(mode, identity=3):
    picture = BLACK.copy()
    labels = []
    draw_vehicle(picture, labels, vehicle(identity, 160, 200, mode, size=(100, 80)))
    write_labels(picture, labels)
    return picture


def share_of_lower_edge(picture, colour):
    return (picture[200, 110:211] == colour).all(axis=1).mean()


def test_a_tracked_vehicle_has_a_closed_box_in_its_own_colour():
    assert share_of_lower_edge(drawn(TrackMode.TRACKING), identity_colour(3)) == 1.0
    assert share_of_lower_edge(drawn(TrackMode.TRACKING, 4), identity_colour(3)) == 0.0


def test_an_occluded_vehicle_is_dashed():
    share = share_of_lower_edge(drawn(TrackMode.OCCLUDED), identity_colour(3))
    assert 0.4 < share < 0.8


@pytest.mark.parametrize("mode", [TrackMode.TENTATIVE, TrackMode.LOST])
def test_what_is_not_known_to_be_there_is_not_drawn(mode):
    assert not drawn(mode).any()


def test_a_trail_is_drawn_behind_a_vehicle_until_it_is_lost():
    trails, counter = Trails(), Counter(CountingPlan())
    for index in range(100):
        estimates = [
            vehicle(1, 100 + index, 200),
            vehicle(2, 100 + index, 150, TrackMode.TENTATIVE),
        ]
        trails.add(estimates)
    picture = frame_with_vehicles(BLACK, "", estimates, counter, trails)
    on_road = picture[200, :180].any(axis=1)
    assert on_road[145:].all()  # 60 positions, the last at 199
    assert not on_road[:139].any()
    assert not picture[150, :180].any()
    trails.add([vehicle(1, 200, 200, TrackMode.LOST)])
    assert trails.of == {}


def test_a_speed_is_written_where_the_road_is_known(monkeypatch):
    written = []
    say = lambda _, words, *rest, **how: written.append(words)  # noqa: E731
    monkeypatch.setattr(drawing, "write_words", say)
    corners = ((0.0, 0.0), (320.0, 0.0), (320.0, 240.0), (0.0, 240.0))
    pairs = [Pair((x, y), (x / 10, y / 10)) for x, y in corners]
    for plane, said in (
        (RoadPlane.of_pairs(pairs, None, margin=0.0, coarsest=1.0), "#1 car  36 km/h"),
        (None, "#1 car"),
    ):
        counter = Counter(CountingPlan(), plane)
        for index in range(25):
            estimates = [vehicle(1, 50 + 4 * index, 200)]  # 4 px in 40 ms are 10 m/s
            counter.update(estimates, index * 40_000_000)
        frame_with_vehicles(BLACK, "", estimates, counter, Trails())
        assert said in written
        written.clear()


def test_numbers_stand_above_the_box():
    assert drawn(TrackMode.TRACKING)[105:118, 108:150].any()


@pytest.mark.parametrize(
    ("box", "rows"),
    [
        ((-500.0, -500.0, 20.0, 20.0), []),
        ((1e9, 1e9, 1e9, 1e9), []),
        ((-1e12, 5.0, 2e12, 9.0), [5, 14]),
    ],
)
@pytest.mark.parametrize("dashed", [True, False])
def test_of_boxes_far_outside_what_is_in_the_image_is_drawn(box, rows, dashed):
    picture = BLACK.copy()
    draw_box(picture, Box(*box), (255, 255, 255), 1, dashed=dashed)
    assert np.flatnonzero(picture.any(axis=(1, 2))).tolist() == rows


def test_colours_of_neighbouring_numbers_differ():
    colours = np.array([identity_colour(identity) for identity in range(1, 201)], float)
    steps = np.abs(np.diff(colours, axis=0)).sum(axis=1)
    assert steps.min() > 100
    assert colours.max(axis=1).min() == 255  # bright enough for a dark road


def test_the_frame_stays_as_it_was():
    frame = BLACK.copy()
    picture = frame_with_vehicles(
        frame, "0:00.0", [vehicle(1, 160, 200)], Counter(CountingPlan()), Trails()
    )
    assert picture.any()
    assert not frame.any()


def test_lines_and_zones_are_drawn_with_their_counts():
    plan = CountingPlan(
        (CountingLine("exit", (0.0, 150.0), (320.0, 150.0)),),
        (CountingZone("yard", ((10.0, 200.0), (90.0, 200.0), (90.0, 230.0), (10.0, 230.0))),),
    )
    counter = Counter(plan)
    picture = frame_with_vehicles(BLACK, "", [], counter, Trails())
    assert picture[150, 5:315].all()
    assert picture[200:230, 10].all()
    for index, bottom in enumerate([120, 180]):
        counter.update([vehicle(1, 200, bottom)], index)
    other = frame_with_vehicles(BLACK, "", [], counter, Trails())
    assert (picture != other).any()  # 1 in


def written(monkeypatch, estimates, words=""):
    """Return the rectangles of the words that are written, by the words."""
    places = {}

    def note(picture, words, corner, colour, width=1, **how):
        scale, pen = 0.45 * width, max(1, round(width))
        (across, _), _ = cv2.getTextSize(words, cv2.FONT_HERSHEY_SIMPLEX, scale, pen)
        # With the dark edge around the letters.
        left, right = corner[0] - pen, corner[0] + across + pen
        places[words] = (left, corner[1] - 10 * width - pen, right, corner[1] + pen)

    monkeypatch.setattr(drawing, "write_words", note)
    frame_with_vehicles(BLACK, words, estimates, Counter(CountingPlan()), Trails())
    return places


def test_words_do_not_cover_each_other_nor_leave_the_picture(monkeypatch):
    beside = [(150, 120), (165, 122), (150, 140), (300, 30), (20, 24), (318, 32)]
    estimates = [vehicle(n, x, y, size=(24, 18)) for n, (x, y) in enumerate(beside, start=1)]
    places = written(monkeypatch, estimates, "0:01.0  frame 30  6 vehicles")
    assert len(places) == 7
    edges = np.array(list(places.values()), float)
    assert not np.triu(intersections(edges[:, None], edges[None]), 1).any()
    assert edges.min() >= 0
    assert (edges[:, 2:] <= (320, 240)).all()


def test_a_vehicle_in_a_crowd_still_has_its_number(monkeypatch):
    estimates = [vehicle(n, 150, 120, size=(24, 18)) for n in range(1, 9)]
    assert {words.split()[0] for words in written(monkeypatch, estimates) if words} == {
        f"#{number}" for number in range(1, 9)
    }


def test_a_grid_can_be_read_in_4k():
    """The words grow with the image: seven of them are not as small as those of VGA."""
    vga, uhd = (
        draw_pixel_grid(np.zeros(size, np.uint8)) for size in ((480, 640, 3), (2160, 3840, 3))
    )
    white_vga, white_uhd = ((one == 255).all(axis=2).sum() for one in (vga, uhd))
    assert white_uhd > 4 * white_vga


@pytest.mark.parametrize("corner", [(0.0, 5.0), (319.0, 5.0), (0.0, 239.0), (319.0, 239.0)])
def test_the_name_of_a_line_at_the_border_is_whole(monkeypatch, corner):
    places = {}
    note = lambda _, words, at, colour, width=1, **how: places.update({words: (at, width)})  # noqa: E731
    monkeypatch.setattr(drawing, "write_words", note)
    plan = CountingPlan((CountingLine("stop line", corner, (160.0, 120.0)),), ())
    frame_with_vehicles(BLACK, "", [], Counter(plan), Trails())
    ((words, ((left, bottom), width)),) = places.items()
    pen = max(1, round(width))
    (across, _), _ = cv2.getTextSize(words, cv2.FONT_HERSHEY_SIMPLEX, 0.45 * width, pen)
    assert left >= pen and left + across + pen <= 320
    assert bottom - 10 * width >= 0 and bottom + pen <= 240


def test_words_about_all_are_shaded_where_a_camera_has_its_own():
    caption = np.full((240, 320, 3), 250, np.uint8)
    picture = frame_with_vehicles(caption, "0:00.0", [], Counter(CountingPlan()), Trails())
    # Between the letters, and beside the words.
    assert (picture[:30, :100] == int(0.35 * 250)).all(axis=2).sum() > 300
    assert (picture[:, 160:] == 250).all()


@pytest.mark.parametrize(("size", "least"), [((180, 320), 9), ((360, 640), 16), ((720, 1280), 18)])
def test_letters_of_small_video_are_legible(size, least):
    picture = np.zeros((*size, 3), np.uint8)
    drawing.write_line(picture, "HHH", (255, 255, 255))
    rows = np.flatnonzero(picture.any(axis=(1, 2)))
    assert least <= rows[-1] - rows[0] + 1 <= size[0] / 10 + 2
