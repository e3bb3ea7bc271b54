# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One pass over a source: what is rejected, noted and forgotten."""

import io
from types import SimpleNamespace

import numpy as np
import pytest
from failing import failing
from traffic_samples import vehicle

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.following import counted_vehicles
from vehicle_pf_tracker.following.traffic_following import TrafficRun
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.results.traffic_results import TrackFiles
from vehicle_pf_tracker.trackers.attempts import TrackerError
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

PERIOD_NS = 40_000_000
FRAME = np.random.default_rng(0).integers(90, 120, (240, 320, 3), np.uint8)


def stamped(stamps, unreadable=()):
    for number, stamp in enumerate(stamps, start=1):
        yield number, StampedFrame(stamp, None if number in unreadable else FRAME)


def driving(number):
    """Detection of a vehicle that drives down by 3 px per frame."""
    return Detections.make([[100, 3 * (number % 40), 30, 20]], [0.9], ["car"])


DRIVING = SimpleNamespace(of=driving, notices=[], misfit=lambda size: "")


@pytest.fixture
def follow():
    def call(stamps, *, unreadable=(), counter=None, targets=None, **options):
        counter = counter or Counter(CountingPlan())
        run = TrafficRun(TrafficSession(MultiVehicleTracker()), counter, **options)
        table, mot = io.StringIO(), io.StringIO()
        files = TrackFiles(table, mot, None)
        run.follow_all(stamped(stamps, unreadable), files, targets=targets or {})
        files.finish()
        return run, table.getvalue().splitlines()[1:]

    return call


def test_frames_that_cannot_be_read_are_noted_and_left_out(follow):
    stamps = [k * PERIOD_NS for k in range(10)]
    run, rows = follow(stamps, unreadable={4, 5}, detections=DRIVING)
    assert run.notices == [f"frame {k} was rejected: it cannot be read" for k in (4, 5)]
    assert run.summary.frames == 8
    assert not any(row.startswith(("4,", "5,")) for row in rows)


def test_a_stray_stamp_is_noted_with_its_frame(follow):
    stamps = [k * PERIOD_NS for k in range(10)]
    stamps[6] += 10**13
    run, _ = follow(stamps, detections=DRIVING)
    (notice,) = run.notices
    assert notice.startswith("frame 7 was rejected: the image's stamp leaps ahead")


def test_an_irregularity_that_lasts_is_noted_once(follow):
    run, _ = follow([5] * 60, detections=DRIVING)
    assert run.notices == ["frame 2: repeated stamp"]


@pytest.mark.parametrize(("count", "words"), [(1, "1 vehicle"), (2, "2 vehicles")])
def test_a_picture_tells_the_number_of_vehicles(follow, monkeypatch, count, words):
    run, _ = follow([k * PERIOD_NS for k in range(2)])
    run.session.detected.images = 1
    run.estimates = [vehicle(number, 160, 200) for number in range(count)]
    monkeypatch.setattr(counted_vehicles, "frame_with_vehicles", lambda _, words, *rest: words)
    assert run.drawn(FRAME, "0:00.0  ") == f"0:00.0  {words}"


def test_very_many_notices_are_counted(follow):
    stamps = [k * PERIOD_NS for k in range(500)]
    run, _ = follow(stamps, unreadable=set(range(1, 501)))
    assert len(run.notices) == 21
    assert run.notices[-1] == "and 480 more notices"


def test_a_recording_that_begins_again_counts_its_vehicles_again(follow):
    counter = Counter(CountingPlan(lines=(CountingLine("l", (0, 80), (320, 80)),)))
    once = [k * PERIOD_NS + 10**12 for k in range(40)]
    run, _ = follow([*once, *once], counter=counter, detections=DRIVING)
    assert run.session.restarts == 1
    assert counter.count("l", "in") == 2
    assert len(run.summary.vehicles) == 2  # no number is given again


def test_a_name_stays_with_its_vehicle_when_the_tracker_starts_anew(follow, monkeypatch):
    targets = {"van": {2: Box(50, 50, 30, 20), 8: Box(60, 60, 30, 20)}}
    monkeypatch.setattr(MultiVehicleTracker, "step", failing(MultiVehicleTracker.step, {3, 4}))
    run, rows = follow([k * PERIOD_NS for k in range(10)], targets=targets)
    by_frame = {int(row.split(",")[0]): int(row.split(",")[2]) for row in rows}
    assert by_frame == {3: 1, 5: 2, 6: 2, 7: 2, 8: 2, 9: 3, 10: 3}
    assert len(rows) == len(by_frame)
    assert [words.partition(":")[0] for words in run.notices] == ["frame 4 was rejected", "frame 5"]


def test_a_broken_tracker_ends_the_run(follow, monkeypatch):
    monkeypatch.setattr(MultiVehicleTracker, "step", lambda *_: 1 / 0)
    with pytest.raises(TrackerError, match="division by zero"):
        follow([0, PERIOD_NS])


def test_a_name_that_comes_again_replaces_the_vehicle(follow):
    targets = {
        "van": {2: Box(50, 50, 30, 20), 5: Box(60, 60, 30, 20)},
        "1": {2: Box(200, 100, 30, 20)},
    }
    _, rows = follow([k * PERIOD_NS for k in range(8)], targets=targets)
    by_frame = {}
    for row in rows:
        words = row.split(",")
        by_frame.setdefault(int(words[0]), set()).add((int(words[2]), words[11]))
    assert by_frame[3] == by_frame[5] == {(1, "van"), (2, "")}
    assert by_frame[6] == {(2, ""), (3, "van")}


def test_a_target_outside_the_image_names_its_frame(follow):
    with pytest.raises(InputError, match="in frame 3, the target 500,5,10,10 has its centre"):
        follow([k * PERIOD_NS for k in range(5)], targets={"1": {3: Box(500, 5, 10, 10)}})
