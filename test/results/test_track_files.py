# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of a run over many vehicles."""

import csv
import io
import math
from dataclasses import replace

import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.results.traffic_results import TrackFiles, track_files
from vehicle_pf_tracker.trackers.traffic.estimate import SCENE_OCCLUDER, TrackEstimate, TrackMode

SEEN = TrackEstimate(
    identity=7,
    box=Box(10.123456, 20.0, 30.0, 40.0),
    velocity=(1.5, -0.1),
    mode=TrackMode.TRACKING,
    confidence=0.9,
    label="car",
    score=0.4,
    age=12.0,
    hidden_by=None,
    serial=7,
)
HIDDEN = replace(
    SEEN, identity=8, serial=8, mode=TrackMode.OCCLUDED, confidence=0.8, score=math.nan, hidden_by=7
)
TENTATIVE = replace(SEEN, identity=0, serial=9, mode=TrackMode.TENTATIVE)
LOST = replace(SEEN, identity=10, serial=10, mode=TrackMode.LOST, hidden_by=SCENE_OCCLUDER)
ALL = (SEEN, HIDDEN, TENTATIVE, LOST)


def test_the_mot_file_has_confirmed_vehicles_predicted_ones_with_less_confidence(tmp_path):
    with track_files(tmp_path) as files:
        files.write(3, 100, ALL)
    assert (tmp_path / "tracks.txt").read_text() == (
        "3,7,10.12,20.00,30.00,40.00,0.9000,-1,-1,-1\n3,8,10.12,20.00,30.00,40.00,0.4000,-1,-1,-1\n"
    )


def test_a_vehicle_has_its_number_from_its_first_detection_on(tmp_path):
    confirmed = replace(TENTATIVE, identity=5, mode=TrackMode.TRACKING)
    other = replace(TENTATIVE, serial=10)
    with track_files(tmp_path) as files:
        files.write(1, 100, [TENTATIVE, other])
        files.write(2, 200, [TENTATIVE])
        assert (tmp_path / "tracks.txt").exists() is False
        files.write(3, 300, [confirmed])
    rows = (tmp_path / "tracks.txt").read_text().splitlines()
    assert [row.split(",")[:2] for row in rows] == [["1", "5"], ["2", "5"], ["3", "5"]]


def test_a_vehicle_found_again_has_the_boxes_of_the_track_that_it_was(tmp_path):
    ghost, seen = (
        replace(HIDDEN, hidden_by=SCENE_OCCLUDER),
        replace(TENTATIVE, box=Box(90, 20, 30, 40)),
    )
    with track_files(tmp_path) as files:
        files.write(1, 100, [HIDDEN])
        files.write(2, 200, [ghost, seen])
        files.write(3, 300, [replace(SEEN, identity=8, serial=8, joined=9)])
    rows = (tmp_path / "tracks.txt").read_text().splitlines()
    assert [row.split(",")[:3] for row in rows] == [
        ["1", "8", "10.12"], ["2", "8", "90.00"], ["3", "8", "10.12"],
    ]  # fmt: skip


def test_the_table_has_every_estimate_with_all_digits(tmp_path):
    with track_files(tmp_path) as files:
        files.write(3, 100, ALL)
    with (tmp_path / "tracks.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["mode"] for row in rows] == ["TRACKING", "OCCLUDED", "LOST"]
    first, second = rows[:2]
    assert float(first["x"]) == SEEN.box.centre[0]  # the very same number
    assert (first["frame"], first["stamp_ns"], first["id"]) == ("3", "100", "7")
    assert (first["width"], first["vy"], first["label"]) == ("30.0", "-0.1", "car")
    assert (first["score"], second["score"]) == ("0.4", "")
    assert [row["hidden_by"] for row in rows] == ["", "7", "scene"]


def test_crossings_are_rows_of_counts(tmp_path):
    crossing = Crossing(
        95, "north, left", "in", 7, "car", TrackMode.OCCLUDED, 123.456, None, (9.0, 8.0), "twice"
    )
    with track_files(tmp_path, counting=True) as files:
        files.write(3, 100, ALL, [crossing])
    with (tmp_path / "counts.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert row == {
        "frame": "3", "stamp_ns": "95", "place": "north, left", "direction": "in", "id": "7",
        "label": "car", "mode": "OCCLUDED", "speed_px_s": "123.46", "speed_kmh": "",
        "doubt": "twice",
    }  # fmt: skip


def test_a_run_that_fails_leaves_the_earlier_one_and_one_that_does_not_replaces_all(tmp_path):
    with track_files(tmp_path, counting=True) as files:
        files.write(1, 0, ALL)
    before = {path.name: path.read_text() for path in tmp_path.iterdir()}

    def write_and_fail():
        with track_files(tmp_path) as files:
            files.write(2, 0, ALL)
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write_and_fail()
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before
    with track_files(tmp_path) as files:
        files.write(2, 0, ALL)
    assert {path.name for path in tmp_path.iterdir()} == {"tracks.csv", "tracks.txt"}


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(InputError, match="cannot write"), track_files(tmp_path / "none"):
        pass


def test_a_crossing_that_is_withdrawn_is_in_doubt(tmp_path):
    first, second = (
        Crossing(1000 * at, "stop", "in", at, "car", TrackMode.TRACKING, None, None, (9.0, 8.0))
        for at in (1, 2)
    )
    with track_files(tmp_path, counting=True) as files:
        files.write(1, 1000, ALL, [first])
        files.write(2, 2000, ALL, [second])
        files.write(3, 3000, ALL, withdrawn=[second])
    with (tmp_path / "counts.csv").open() as file:
        rows = [(row["frame"], row["id"], row["doubt"]) for row in csv.DictReader(file)]
    assert rows == [("1", "1", ""), ("2", "2", "twice")]


def test_crossings_wait_for_ten_minutes_and_no_longer():
    counts = io.StringIO()
    files = TrackFiles(io.StringIO(), io.StringIO(), counts)
    crossing = Crossing(0, "stop", "in", 1, "car", TrackMode.TRACKING, None, None, (9.0, 8.0))
    files.write(1, 0, ALL, [crossing])
    files.write(2, 600 * 10**9, ALL)
    assert len(counts.getvalue().splitlines()) == 1  # the names of the columns
    files.write(3, 601 * 10**9, ALL)
    assert len(counts.getvalue().splitlines()) == 2
