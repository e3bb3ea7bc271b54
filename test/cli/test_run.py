# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import itertools
import json

import pytest
from mcap.writer import CompressionType
from small_recordings import COUNT, TARGET, box_of, record, record_two_cameras

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, read_estimates
from vehicle_pf_tracker.trackers.papers.apf import ApfTracker


@pytest.fixture
def run(tmp_path):
    """Call `run` with apf on a recording into a new folder, and return what it wrote."""

    def call(recording, *words, variant="apf"):
        out = tmp_path / "out"
        assert (
            main(
                ["run", str(recording), "--variant", variant, "-o", str(out), "--overwrite", *words]
            )
            == 0
        )
        names = {path.name for path in out.iterdir()}
        assert names - {"metrics.json"} == {"estimates.csv", "run.json", "summary.png"}
        scores = out / "metrics.json"
        metrics = json.loads(scores.read_text()) if scores.exists() else None
        info = json.loads((out / "run.json").read_text())
        return read_estimates(out / "estimates.csv"), metrics, info

    return call


@pytest.fixture
def bag(tmp_path):
    return record(tmp_path / "bag")


@pytest.mark.parametrize("variant", ["apf", "pf"])
def test_a_recording_with_truth_is_tracked_and_scored(run, bag, variant, capsys):
    rows, metrics, info = run(bag, variant=variant)
    assert [row.frame for row in rows] == list(range(1, COUNT + 1))
    assert (metrics["frames"], metrics["frames_scored"]) == (COUNT, COUNT)
    assert metrics["on_target"] == 1.0
    assert (info["variant"], info["target"]) == (variant, [8.0, 24.0, 16.0, 12.0])
    assert info["recording"] == str(bag)
    assert info["command"][:3] == ["vehicle-pf-tracker", "run", str(bag)]
    out, err = capsys.readouterr()
    assert "│ on target " in out
    assert [line for line in err.splitlines() if not line.startswith("tracked")] == []


def test_a_trajectory_and_its_truth_have_a_line_per_frame(run, bag, tmp_path, capsys):
    path = tmp_path / "seen.tum"
    rows, *_ = run(bag, "--tum", str(path))
    estimated = [line.split() for line in path.read_text().splitlines()]
    assert [(float(x), float(y)) for _, x, y, *_ in estimated] == [row.position for row in rows]
    true = (tmp_path / "seen_truth.tum").read_text().splitlines()
    assert [line.split()[0] for line in true] == [line[0] for line in estimated]
    assert len(true) == COUNT
    assert main(["run", str(bag), "-o", str(tmp_path / "other"), "--tum", str(path)]) == 1
    assert f"{path} exists; give --overwrite" in capsys.readouterr().err


def test_trajectories_of_two_targets_are_two_files(bag, tmp_path):
    words = ["--target", TARGET, "--target", f"van:{TARGET}", "--variant", "apf"]
    out = ["-o", str(tmp_path / "out"), "--tum", str(tmp_path / "tum" / "seen.tum")]
    assert main(["run", str(bag), *words, *out]) == 0
    names = {path.name for path in (tmp_path / "tum").iterdir()}
    assert names == {"seen_1.tum", "seen_van.tum"}


def test_a_drawn_seed_is_kept(run, bag):
    _, _, info = run(bag, "--seed", "-1")
    assert info["parameters"]["seed"] == -1
    assert info["seed"] >= 0


def test_the_target_may_be_given_where_there_is_no_truth(run, tmp_path):
    recording = record(tmp_path / "bag", truths=())
    rows, metrics, info = run(recording, "--target", TARGET)
    assert rows[0].position == box_of(0).centre
    assert metrics is None
    assert info["target"] == [8.0, 24.0, 16.0, 12.0]


def test_frames_before_the_first_truth_wait(run, tmp_path):
    rows, metrics, info = run(record(tmp_path / "bag", truths=range(3, COUNT)))
    assert [row.mode for row in rows[:4]] == [WAITING_MODE] * 3 + ["TRACKING"]
    assert (metrics["frames_waiting"], info["start_frame"]) == (3, 4)


def test_one_of_two_cameras_can_be_chosen(run, tmp_path):
    recording = record_two_cameras(tmp_path / "bag")
    rows, _, info = run(recording, "--topic", "/right/image", "--target", TARGET)
    assert (len(rows), info["image_topic"]) == (3, "/right/image")


def test_what_is_left_of_a_truncated_recording_is_used_and_said(run, tmp_path, capsys):
    path = record(tmp_path / "bag", compression=CompressionType.NONE, count=200) / "bag_0.mcap"
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    rows, metrics, info = run(cut)
    assert 0 < len(rows) == metrics["frames"] < 200
    assert "is truncated" in info["notices"][0]
    assert f"vehicle-pf-tracker: note: {info['notices'][0]}" in capsys.readouterr().err


def test_parameters_come_from_the_file_then_set_then_seed(run, bag, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(
        "/**:\n  ros__parameters:\n    use_sim_time: true\n    queue_depth: 10\n    seed: 3\n"
        "    num_particles: 50\n    motion:\n      sigma_w: 4\n    target.x: 9.0\n"
        "    target.y: 25.0\n    target.width: 14.0\n    target.height: 10.0\n"
        "    qos_overrides./image.subscription.depth: 5\n"
    )
    _, _, info = run(bag, "--params", str(path), "--set", "num_particles=60", "--seed", "4")
    used = info["parameters"]
    assert (used["seed"], used["num_particles"], used["motion.sigma_w"]) == (4, 60, 4.0)
    assert info["target"] == [9.0, 25.0, 14.0, 10.0]


def test_the_target_of_the_command_line_goes_before_that_of_the_file(run, bag):
    words = [f"--set=target.{name}=10" for name in ("x", "y", "width", "height")]
    assert run(bag, *words)[2]["target"] == [10.0] * 4
    assert run(bag, *words, "--target", TARGET)[2]["target"] == [8.0, 24.0, 16.0, 12.0]


def test_a_road_adds_its_columns(tmp_path):
    recording = record(tmp_path / "rec")
    pairs = "0,0=0,0; 96,0=9.6,0; 96,64=9.6,6.4; 0,64=0,6.4"
    words = ["run", str(recording), "--variant", "pf", "--set", f"road.pairs={pairs}"]
    assert main([*words, "-o", str(tmp_path / "out")]) == 0
    header, first, *_ = (tmp_path / "out" / "estimates.csv").read_text().splitlines()
    assert header.endswith(
        "step_ms,road_x,road_y,road_velocity_x,road_velocity_y,speed_kmh,speed_sd_kmh"
    )
    row = dict(zip(header.split(","), first.split(","), strict=True))
    assert float(row["road_x"]) == pytest.approx(1.6)
    assert float(row["road_y"]) == pytest.approx(3.6)


def test_an_unexpected_error_costs_its_frame_alone(run, bag, monkeypatch):
    step = ApfTracker.step

    def fail_once(tracker, frame, *elapsed):
        if next(calls) == 3:  # the first frame is started on
            raise ZeroDivisionError("by zero")
        return step(tracker, frame, *elapsed)

    calls = itertools.count(1)
    monkeypatch.setattr(ApfTracker, "step", fail_once)
    rows, _, info = run(bag)
    assert [row.frame for row in rows if row.mode == REJECTED_MODE] == [4]
    assert len(rows) == COUNT
    assert "frame 4 was rejected: unexpected ZeroDivisionError: by zero" in info["notices"]
