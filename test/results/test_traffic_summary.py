# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Summary and picture of a run over many vehicles."""

from dataclasses import replace

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.parameters.counting_plan import (
    CountingLine,
    CountingPlan,
    CountingZone,
    Region,
)
from vehicle_pf_tracker.results.traffic_summary import TrafficSummary
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.heat_picture import HeatPicture
from vehicle_pf_tracker.showing.path_picture import PathPicture
from vehicle_pf_tracker.showing.traffic_drawing import identity_colour
from vehicle_pf_tracker.trackers.traffic.estimate import BORDER_OCCLUDER, TrackEstimate, TrackMode

MODES = {
    "t": TrackMode.TENTATIVE,
    "T": TrackMode.TRACKING,
    "O": TrackMode.OCCLUDED,
    "L": TrackMode.LOST,
    "B": TrackMode.LOST,
}
"""B: beyond the border."""

NOWHERE = Counter(CountingPlan())


def estimate(identity, mode, box=None, label=""):
    hider = BORDER_OCCLUDER if mode == "B" else None
    box = box or Box(0, 0, 9, 9)
    return TrackEstimate(
        identity, box, (0, 0), MODES[mode], 0.9, label, 0.5, 1.0, hider, serial=identity
    )


def summed(*lives):
    """Add the lives of vehicles 1, 2, ...: a letter per frame, - where it is not followed."""
    summary = TrafficSummary(NOWHERE)
    for modes in zip(*lives, strict=True):
        found = [estimate(k, mode) for k, mode in enumerate(modes, start=1) if mode != "-"]
        summary.add(found)
    return summary


def test_occlusions_survived_are_counted():
    summary = summed("TTOOTTOLTT", "TTTTTOOOLL", "--tttTTTTT")
    assert summary.survived == 2
    assert summary.ended_hidden == 1
    assert len(summary.vehicles) == 3
    assert summary.most_at_once == 3


def test_the_occupancy_of_a_single_image_is_unknown():
    square = CountingZone("yard", ((0, 0), (50, 0), (50, 50), (0, 50)))
    summary = TrafficSummary(Counter(CountingPlan(zones=(square,))))
    summary.add([estimate(1, "T")])
    assert summary.zones.add(0, {"yard": 1}) + summary.zones.rest() == []
    (yard,) = summary.to_json()["zones"]
    assert yard == {"zone": "yard", "seconds": 0.0, "mean": None, "max": None, "occupied": None}
    assert summary.sentences()[-1].endswith("occupancy unknown, as no time passed between images")


def test_leaving_is_no_occlusion_and_ends_none():
    summary = summed("TTTTTTBB", "TTTOOOBB", "TTTTBBTT")
    assert summary.survived == 0
    assert summary.ended_hidden == 1


def test_one_that_is_not_followed_any_more_has_left_unless_it_was_hidden():
    ended = summed("TTTT--", "TTOO--", "TTT---", "TTTTTT").to_json()["ended"]
    assert (ended["border"], ended["hidden"], ended["in_view"]) == (2, 1, 1)


def test_a_vehicle_that_is_never_confirmed_is_none():
    summary = summed("ttttt-----")
    assert summary.vehicles == {}
    assert summary.to_json()["vehicles"] == 0


def test_a_late_class_counts():
    summary = TrafficSummary(NOWHERE)
    summary.add([estimate(1, "T")])
    summary.add([estimate(1, "T", label="bus")])
    assert "1 vehicle in 2 frames, at most 1 at once (1 bus)" in summary.sentences()


def test_a_lorry_that_is_a_car_from_far_away_is_a_lorry():
    summary = TrafficSummary(NOWHERE)
    for label in ("car", "truck", "", "truck", "truck", "car"):
        summary.add([estimate(1, "T", label=label)])
    assert "(1 truck)" in summary.sentences()[0]


def drive(picture, count=30, width=320):
    frame = np.zeros((240, width, 3), np.uint8)
    for index in range(count):
        boxes = [Box(20 + 8 * index, 60 * k, 20, 20) for k in range(1, 4)]
        modes = "T" * 2 + ("O" if 10 <= index < 20 else "T")
        picture.add(frame, [estimate(k + 1, mode, boxes[k]) for k, mode in enumerate(modes)])


def test_the_picture_has_every_path_in_its_colour(tmp_path):
    picture = PathPicture()
    drive(picture)
    picture.write(tmp_path / "paths.png", NOWHERE)
    image = cv2.imread(str(tmp_path / "paths.png"))[:, :, ::-1]
    assert image.shape == (480, 640, 3)
    for k in range(3):
        row = image[2 * (60 * (k + 1) + 10)]
        colour = np.array(identity_colour(k + 1))
        share = (row[70:500] == colour).all(axis=1).mean()
        assert share > (0.9 if k < 2 else 0.5)
    hidden = image[2 * 190, 2 * (20 + 8 * 15 + 10)]
    assert 0 < hidden.max() < 150  # the path under the occluder is darker


def test_no_frame_no_picture(tmp_path):
    PathPicture().write(tmp_path / "paths.png", NOWHERE)
    assert not (tmp_path / "paths.png").exists()


def test_frames_of_another_size_begin_the_picture_anew(tmp_path):
    picture = PathPicture()
    drive(picture, width=160)
    drive(picture, width=320)
    picture.write(tmp_path / "paths.png", NOWHERE)
    assert cv2.imread(str(tmp_path / "paths.png")).shape == (480, 640, 3)


def test_the_road_is_blue_where_vehicles_drove_and_red_where_they_stood(tmp_path, monkeypatch):
    written = []
    say = lambda _, words, *rest, **how: written.append(words)  # noqa: E731
    monkeypatch.setattr(drawing, "write_words", say)
    heat, ground = HeatPicture(), np.full((240, 320, 3), 90, np.uint8)
    heat.add(ground[:120], [estimate(9, "T", Box(0, 0, 300, 100))], 0, 0.04)
    for index in range(50):
        drives = replace(estimate(1, "T", Box(20 + 4 * index, 60, 20, 20)), velocity=(4.0, 0.0))
        stands = replace(estimate(2, "O", Box(100, 150, 40, 40)), velocity=(0.1, 0.0))
        away = [estimate(3, mode, Box(200, 200, 40, 30)) for mode in "tL"]
        heat.add(ground, [drives, stands, *away], 10**12 + index * 80_000_000, 0.04)
    heat.write(tmp_path / "heat.png", ground)
    assert written == ["drove: 0 to 4.0 s, log.", "stood: 0 to 4.0 s, log."]  # by the stamps
    image = cv2.imread(str(tmp_path / "heat.png"))[:, :, ::-1].astype(int)
    red, green, blue = image[78, 120]  # the lower part of the box
    assert blue > green > red
    red, _, blue = image[185, 120]
    assert red > blue + 100
    for row, column in ((62, 120), (155, 120), (225, 220), (50, 310)):
        assert (image[row, column] == 90).all()  # upper parts, and those that are not there


def test_a_short_stop_is_faint_beside_a_long_one(tmp_path):
    heat, ground = HeatPicture(), np.full((240, 320, 3), 90, np.uint8)
    long = replace(estimate(1, "T", Box(20, 150, 40, 40)), velocity=(0.0, 0.0))
    short = replace(estimate(2, "T", Box(200, 150, 40, 40)), velocity=(0.0, 0.0))
    for index in range(1500):
        heat.add(ground, [long, short][: 1 + (index < 3)], index * 40_000_000, 0.04)
    heat.write(tmp_path / "heat.png", ground)
    image = cv2.imread(str(tmp_path / "heat.png"))[:, :, ::-1].astype(int)
    minute, moment = image[185, 40], image[185, 220]
    assert minute[0] - minute[2] > 100
    assert 0 < moment[0] - moment[2] < 15
    bar = image[35, 6:102]  # of the standing ones, from grey to red
    assert bar[0, 0] - bar[0, 2] < 20 and bar[-1, 0] - bar[-1, 2] > 100


def test_many_paths_are_lanes_coloured_by_heading(tmp_path):
    picture = PathPicture()
    frame = np.zeros((240, 320, 3), np.uint8)
    for vehicle in range(30):
        for index in range(40):
            x = 7 * index if vehicle % 2 else 300 - 7 * index
            box = Box(x, 60 + 80 * (vehicle % 2) + vehicle % 3, 20, 20)
            picture.add(frame, [estimate(vehicle + 1, "T", box)])
    picture.write(tmp_path / "paths.png", NOWHERE)
    image = cv2.imread(str(tmp_path / "paths.png"))[:, :, ::-1].astype(int)
    there = image[2 * 70, 100:300].mean(axis=0)
    back = image[2 * 150, 100:300].mean(axis=0)
    assert np.abs(there - back).max() > 100  # opposite headings, unlike colours
    assert len({tuple(colour) for colour in image[2 * 70, 100:300].tolist()}) < 12


def test_a_vehicle_that_is_found_elsewhere_draws_no_line_across(tmp_path):
    picture = PathPicture()
    frame = np.zeros((240, 320, 3), np.uint8)
    for x in (20, 24, 28, 270, 274):
        picture.add(frame, [estimate(1, "T", Box(x, 60, 20, 20))])
    picture.write(tmp_path / "paths.png", NOWHERE)
    image = cv2.imread(str(tmp_path / "paths.png"))
    assert not image[2 * 70, 2 * 60 : 2 * 250].any()


def test_driving_out_of_a_region_of_interest_is_leaving():
    region = Region(((0.0, 0.0), (200.0, 0.0), (200.0, 100.0), (0.0, 100.0)), is_inside=True)
    ended = []
    for last_seen in (190.0, 100.0):  # its front reaches over the edge; in the middle
        summary = TrafficSummary(Counter(CountingPlan(regions=(region,))))
        for x in np.arange(0.0, 240.0, 10.0):
            one = estimate(1, "T" if x <= last_seen else "O", Box(x - 15, 40, 30, 20))
            summary.add([replace(one, velocity=(10.0, 0.0))])
        ended.append(summary.ended_hidden)
    assert ended == [0, 1]


def test_where_vehicles_went_is_told_apart():
    summary = TrafficSummary(NOWHERE)
    for size, mode in ((40, "TTTT"), (20, "TTTT"), (12, "TTTT"), (12, "TBOO")):
        crossing = estimate(1, mode[0])
        leaves = estimate(2, mode[1], Box(300, 60, size, 9))
        recedes = estimate(3, mode[2], Box(100, 60, size, 9))  # to less than half of its size
        hidden = estimate(4, mode[3], Box(20, 60, 40, 9))
        summary.add([crossing, leaves, recedes, hidden])
    assert summary.to_json()["ended"] == {
        "in_view": 1, "border": 1, "roi": 0, "far": 1, "hidden": 1,
    }  # fmt: skip
    assert summary.ended_hidden == 1
    _, occlusions, ends, far = summary.sentences()
    assert "1 vehicle not seen again" in occlusions
    assert ends == "1 left over the border, 1 too far away; 1 in view at the end"
    assert far.startswith("vehicles were followed down to 12 px")


def test_two_wheelers_have_counts_of_their_own():
    line = CountingLine("line", (0.0, 50.0), (320.0, 50.0))
    counter = Counter(CountingPlan(lines=(line,)), apart={"bicycle"})
    summary = TrafficSummary(counter)
    for index in range(20):
        found = [
            estimate(k, "T", Box(40 * k, 6 * index, 20, 10), label)
            for k, label in enumerate(("car", "bicycle", ""), start=1)
        ]
        counter.update(found, index * 40_000_000)
        summary.add(found)
    assert counter.count("line", "in") == 2
    first, *_, last = summary.sentences()
    assert first == "2 vehicles in 20 frames, at most 2 at once (1 car) besides 1 bicycle"
    assert last.startswith("line line: 2 in (1 car) besides 1 bicycle, 0 out; 90 % intervals ")
    assert {(one["class"], one["low"] > 0) for one in summary.to_json()["intervals"]} == {
        (None, True), ("car", True), ("bicycle", True), (None, False),
    }  # fmt: skip
    document = summary.to_json()
    assert (document["vehicles"], document["counted_apart"]) == (2, {"bicycle": 1})
    assert {"place": "line", "direction": "in", "class": "bicycle", "count": 1} in document[
        "counts"
    ]
