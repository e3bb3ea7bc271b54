# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes with many vehicles, their truth, and simulated detectors."""

from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from laboratory.scenes import TRAFFIC_SCENES, make_traffic_scene
from laboratory.scenes.driver_model import Driver, Hold, simulate
from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.scenes.simulated_detector import SIMULATED_DETECTORS, SimulatedDetector
from laboratory.scenes.traffic_perspective import road_file
from laboratory.scenes.traffic_scene import TrafficScene, VehicleTruth, traffic
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.traffic.box_matches import matches
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence
from vehicle_pf_tracker.parameters.road import parse_pairs
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.courses import standing
from vehicle_pf_tracker.scenes.scene import Actor


def block(box, colour=(200, 0, 0)):
    """Shadow and body of a vehicle that stands still."""
    shadow = Actor(Sprite.plain((0, 0, 0), 0.0), standing(box), hides=False)
    return shadow, Actor(Sprite.plain(colour), standing(box))


def still(*boxes, obstacles=()):
    return TrafficScene(
        width=60,
        height=40,
        frame_rate=30,
        frame_count=2,
        backdrop=lambda: np.zeros((40, 60, 3), np.float32),
        vehicles=tuple(block(box, (50 + 50 * n, 0, 0)) for n, box in enumerate(boxes)),
        obstacles=obstacles,
        camera=Camera(0.0, 0),
    )


def test_the_nearer_vehicle_hides_the_farther_one():
    scene = still(Box(10, 10, 20, 20), Box(20, 12, 20, 20))  # the second stands lower
    far, near = scene.truth(0)
    assert (far.identity, near.identity) == (1, 2)
    assert far.visible == pytest.approx(1 - 10 * 18 / 400)
    assert near.visible == 1
    frame, truth = next(scene.frames())
    assert truth == scene.truth(0)
    assert (frame[20, 25, 0], frame[20, 15, 0]) == (100, 50)


def test_obstacles_hide_all_and_the_border_hides_none():
    bridge = Actor(Sprite.plain((9, 9, 9)), standing(Box(0, 0, 10, 40)))
    (one,) = still(Box(-10, 10, 40, 10), obstacles=(bridge,)).truth(0)
    assert one.box == Box(0, 10, 30, 10)
    assert one.whole == Box(-10, 10, 40, 10)
    assert one.visible == pytest.approx(20 / 30)


def drivers(*places, speed=15.0):
    return [Driver(lane, front, 4.0, speed) for lane, front in places]


def test_nobody_drives_into_the_one_ahead_when_a_light_is_red():
    places = [(0, 40.0 - 12 * number) for number in range(4)]
    flow = simulate(drivers(*places), 1, 1050, 30, [Hold(90.0, 1.0, 20.0)])
    gaps = flow.front[:-1] - 4.0 - flow.front[1:]
    assert gaps.min() > 0
    waiting = flow.front[:, 560]
    assert waiting[0] <= 90.0
    assert np.abs(flow.front[:, 561] - waiting).max() < 0.02  # all stand
    assert (flow.front[:, -1] > 95).all()  # and go on
    assert (np.diff(flow.front) >= 0).all()


def test_fast_drivers_change_lanes_only_if_they_may():
    slow_ahead = [Driver(0, 40.0, 10.0, 8.0), Driver(0, 10.0, 4.0, 20.0)]
    stays = simulate(slow_ahead, 2, 300, 30)
    assert (stays.lane == 0).all()
    changes = simulate(slow_ahead, 2, 300, 30, changing=True)
    assert changes.lane[1, -1] == 1
    assert changes.front[1, -1] > changes.front[0, -1]
    assert stays.front[1, -1] < stays.front[0, -1]
    assert np.abs(np.diff(changes.lane[1])).max() < 0.03  # smoothly


@pytest.mark.parametrize("name", TRAFFIC_SCENES)
def test_every_scene_is_what_its_settings_say(name):
    kind = TRAFFIC_SCENES[name]
    scene = make_traffic_scene(name)
    assert len(scene.vehicles) == kind.settings["vehicles"]
    assert scene.frame_count == kind.settings.get("frames", 400)
    assert kind.summary


def total_occlusions(scene, step=1):
    """Times that a vehicle which was seen is hidden and is seen again."""
    count, hidden, seen = 0, set(), set()
    for index in range(0, scene.frame_count, step):
        for one in scene.truth(index):
            if one.visible < 0.1:
                hidden |= {one.identity} & seen
            elif one.visible > 0.3:
                count += one.identity in hidden
                hidden.discard(one.identity)
                seen.add(one.identity)
    return count, seen


@pytest.mark.slow
def test_forty_vehicles_are_hidden_about_two_hundred_times():
    count, seen = total_occlusions(make_traffic_scene("traffic-forty"))
    assert len(seen) == 40
    assert 160 <= count <= 220


def test_the_lorry_hides_the_car_that_overtakes_it():
    assert total_occlusions(make_traffic_scene("traffic-pair"))[0] == 1


FROM_BESIDE = [name for name, kind in TRAFFIC_SCENES.items() if kind.build is traffic]
PERSPECTIVE = sorted(set(TRAFFIC_SCENES) - {*FROM_BESIDE, "traffic-close"})


@pytest.mark.parametrize("name", PERSPECTIVE)
def test_vehicles_in_perspective_stand_where_the_road_says(name):
    scene = make_traffic_scene(name, settings={"frames": 200})
    widths = []
    for one in scene.truth(150):
        if one.box == one.whole:  # all of it is in the image
            left, right = (one.box.x, one.box.x + one.box.width)
            bottom = one.box.y + one.box.height
            ends = scene.road.to_road(np.array([[left, bottom], [right, bottom]]))
            widths.append(np.ptp(ends[:, 0]))
    assert len(widths) >= 5
    assert 1.6 < np.median(widths) < 3.5  # m: a car's front, and something of its side


def test_who_hides_another_is_nearer_and_painted_later():
    settings = {"frames": 160, "noise": 0.0, "vehicles": 6}
    scene = make_traffic_scene("traffic-overtaking", settings=settings)
    index = 150
    whole = scene.truth(index)
    hidden = max((one for one in whole if one.hidden_by), key=lambda one: one.hidden_share)
    assert hidden.hidden_share > 0.2
    nearer = next(one for one in whole if one.identity == hidden.hidden_by)
    assert nearer.depth < hidden.depth
    order = scene.order(index)
    assert order.index(hidden.identity - 1) < order.index(nearer.identity - 1)


def test_a_scene_in_perspective_has_its_road():
    scene = make_traffic_scene("traffic-jam", settings={"frames": 2, "vehicles": 4})
    text = yaml.safe_load(road_file(scene))
    pairs = parse_pairs(text["/**"]["ros__parameters"]["road.pairs"])
    plane = RoadPlane.of_pairs(pairs, None, margin=0.1, coarsest=1.0)
    points = np.array([[100.0, 300.0], [400.0, 200.0]])
    assert plane.to_road(points) == pytest.approx(scene.road.to_road(points), rel=1e-6)


def test_what_there_is_not_is_told():
    with pytest.raises(InputError, match=r"there is no scene 'traffic-fourty'.*traffic-forty"):
        make_traffic_scene("traffic-fourty")
    with pytest.raises(InputError, match="traffic-pair has no setting 'cars'; it has vehicles, "):
        make_traffic_scene("traffic-pair", settings=["cars=3"])


def free(number, x, y):
    box = Box(x, y, 40, 20)
    return VehicleTruth(number, box, box, 1.0)


TRUTHS = [
    [free(number, 2.0 * frame, 40.0 * number) for number in range(1, 6)] for frame in range(300)
]
SIZE = (700, 300)


def found(seed=0, truths=TRUTHS, **changes):
    quiet = {"misses": 0.0, "false_alarms": 0.0, "noise": 0.0, **changes}
    return SimulatedDetector(**quiet).detect(truths, SIZE, seed)


def test_a_perfect_detector_finds_every_box():
    rows = found()
    boxes = [[one.box.x, one.box.y, one.box.width, one.box.height] for now in TRUTHS for one in now]
    assert rows[:, 1:5].tolist() == boxes
    assert rows[:, 0].tolist() == [frame for frame in range(1, 301) for _ in range(5)]
    assert 0.75 < rows[:, 5].mean() < 0.9


def test_misses_are_as_many_and_as_long_as_said():
    rows = found(misses=0.25, miss_length=5.0)
    hit = np.zeros((5, 300), bool)
    hit[(rows[:, 2] / 40 - 1).astype(int), rows[:, 0].astype(int) - 1] = True
    assert 0.2 < 1 - hit.mean() < 0.3
    edges = np.count_nonzero(np.diff(hit.astype(int), axis=1) == -1)
    assert 4 < (~hit).sum() / edges < 6.2


def test_false_alarms_and_noise_are_as_said():
    rows = found(false_alarms=2.0)
    assert 1.8 < (len(rows) - 1500) / 300 < 2.2
    noisy = found(noise=0.1)[:, 1:5] - found()[:, 1:5]
    assert noisy[:, 0].std() == pytest.approx(4.0, rel=0.1)
    assert noisy[:, 1].std() == pytest.approx(2.0, rel=0.1)


def test_hidden_vehicles_are_not_found():
    hidden = [[VehicleTruth(1, one.box, one.whole, 0.2) for one in now[:1]] for now in TRUTHS]
    assert len(found(truths=hidden)) == 0


def test_overlapping_vehicles_may_be_found_as_one():
    side = [free(n, 30.0 * n, 50.0) for n in (1, 2)]
    rows = found(truths=[side] * 200, merges=0.5)
    one = rows[rows[:, 3] == 70]
    assert 70 < len(one) < 130
    assert len(rows) == 400 - len(one)
    assert one[0, 1:5].tolist() == [30, 50, 70, 20]


def test_a_folder_holds_the_scene(tmp_path):
    scene = make_traffic_scene("traffic-bridge", settings={"frames": 90, "vehicles": 6})
    done = []
    write_mot_folder(scene, tmp_path / "b", 0, lambda *counts: done.append(counts))
    assert done[-1] == (90, 90)
    sequence = read_sequence(tmp_path / "b")
    assert (sequence.frame_count, sequence.size) == (90, (640, 360))
    assert set(sequence.detections) == set(SIMULATED_DETECTORS)
    rows, hidden = [], []
    for index in range(90):
        for one in scene.truth(index):
            if min(one.box.width, one.box.height) >= 8:
                rows.append(
                    [index + 1, one.identity, one.box.x, one.box.y, one.box.width, one.box.height]
                )
                hidden.append(round(one.visible, 3) < 0.1)
    np.testing.assert_allclose(sequence.truth, rows, atol=0.0051)
    assert sequence.hidden.tolist() == hidden
    assert any(hidden)
    table = (tmp_path / "b" / "gt" / "occluders.csv").read_text().splitlines()
    assert table[0] == "frame,id,depth,hidden_by,share"
    assert len(table) == 1 + len(rows)
    names = {line.split(",")[3] for line, out in zip(table[1:], hidden, strict=True) if out}
    assert names == {"scene"}  # the bridge
    first = next(sequence.frames()).astype(float)
    assert np.abs(first - next(scene.frames())[0]).mean() < 4
    good = sequence.detections["good"]
    now = sequence.truth[:, 0] == 50
    boxes = good[good[:, 0] == 50, 1:5]
    seen = sequence.truth[now & ~sequence.hidden, 2:]
    assert len(matches(seen, boxes)[0]) >= len(seen) - 1


def test_a_folder_is_not_written_over(tmp_path):
    (tmp_path / "mine").write_text("")
    scene = make_traffic_scene("traffic-pair", settings={"frames": 2})
    with pytest.raises(InputError, match="is not empty"):
        write_mot_folder(scene, tmp_path, 0)
    assert cv2.imread(str(tmp_path / "img1" / "000001.jpg")) is None


def test_the_page_lists_scenes_and_detectors():
    page = (Path(__file__).parents[2] / "docs" / "scenes.md").read_text(encoding="utf-8")
    for name in FROM_BESIDE:
        kind = TRAFFIC_SCENES[name]
        counts = f"{kind.settings['vehicles']} | {kind.settings.get('frames', 400)}"
        assert f"| `{name}` | {kind.summary} | {counts} |" in page
    for name, one in SIMULATED_DETECTORS.items():
        facts = f"{one.misses:.0%} | {one.miss_length:g} frames | {one.false_alarms:g} |"
        merges = f"{one.merges:.0%}" if one.merges else "–"
        row = f"| `{name}` | {facts} {one.noise:.0%} | {merges} |".replace("%", " %")
        assert row in page


def test_vehicles_outside_the_image_have_no_truth():
    assert still(Box(70, 10, 20, 10), Box(-20, 10, 20, 10)).truth(0) == ()


def test_vehicles_on_a_close_road_are_in_view_for_about_a_second_and_shake_with_the_camera():
    scene = make_traffic_scene("traffic-close", settings={"frames": 120, "noise": 0.0})
    paths = {}
    for index in range(scene.frame_count):
        for one in scene.truth(index):
            paths.setdefault(one.identity, []).append(one.box)
    whole = [boxes for boxes in paths.values() if len(boxes) > 5]
    assert 12 < np.median([len(boxes) for boxes in whole]) < 60
    path = max(whole, key=len)
    tops = np.array([box.y for box in path if box.y > 0])
    assert np.abs(np.diff(tops, 2)).max() > 1  # no vehicle does so
    assert any(min(box.x for box in boxes) == 0 for boxes in whole)
    (frame, _), (again, _) = (next(iter(scene.frames())) for _ in range(2))
    assert (frame == again).all()
