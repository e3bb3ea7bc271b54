# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`run` and `traffic` over many sources, in processes here and on a cluster."""

import csv
import json
import os
import shutil
import signal

import cv2
import numpy as np
import pytest
from dask_processes import scheduler, workers
from small_recordings import COUNT, TARGET, frame_of, record, write_video

import vehicle_pf_tracker.cli.run as run_verb
from vehicle_pf_tracker.cli import many_sources
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.workers import cluster

OPENCV = ("--set", "kernels=opencv")
PF = ("--variant", "pf", "--set", "num_particles=40", "--target", TARGET, *OPENCV)
DECIDED_BY_THE_MACHINE = {"run.json", "source.json", "metrics.json"}


@pytest.fixture
def videos(tmp_path):
    """Three small videos of one vehicle each."""
    names = ("east", "north", "west")
    return [write_video(tmp_path / f"{name}.avi", map(frame_of, range(COUNT))) for name in names]


@pytest.fixture
def done(monkeypatch):
    """Follow sources in this process, and name those that were followed."""
    names = []

    def in_turn(function, jobs, _workers, _lost):
        for job in jobs:
            names.append(job.name)
            yield job, function(job)

    monkeypatch.setattr(many_sources, "run_in_processes", in_turn)
    return names


def follow(verb, *words):
    return main([verb, *map(str, words)])


def contents(folder):
    """Return what a run decided: every file, without the times of steps and of the run."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_dir() or path.name in DECIDED_BY_THE_MACHINE:
            continue
        name = str(path.relative_to(folder))
        if path.name == "estimates.csv":
            rows = csv.DictReader(path.read_text().splitlines())
            found[name] = [{**row, "step_ms": ""} for row in rows]
        else:
            found[name] = path.read_bytes()
    return found


def shown(path):
    """Frames of a video, as numbers whose difference has a sign."""
    video = cv2.VideoCapture(str(path))
    return np.array([video.read()[1] for _ in range(COUNT)], float)


def table(folder):
    return list(csv.DictReader((folder / "sources.csv").read_text().splitlines()))


def test_each_source_has_what_its_own_command_gives(videos, tmp_path, done, capsys):
    out = tmp_path / "all"
    assert follow("run", *videos, *PF, "--video", "seen.mp4", "-o", out) == 0
    assert done == ["east", "north", "west"]
    assert follow("run", videos[1], *PF, "--video", tmp_path / "v.mp4", "-o", tmp_path / "one") == 0
    of_one, of_many = contents(tmp_path / "one"), contents(out / "north")
    del of_many["seen.mp4"]
    # x264 now and then makes other bytes of the same frames, 2 levels of 256 apart; the next
    # frame's are 5 apart and more.
    apart = np.abs(shown(out / "north" / "seen.mp4") - shown(tmp_path / "v.mp4"))
    assert apart.shape[0] == COUNT
    assert max(apart.mean(axis=(1, 2, 3))) < 4
    assert of_many == of_one
    assert [
        (row["source"], row["frames"], row["tracked"], row["failed"]) for row in table(out)
    ] == [(name, str(COUNT), str(COUNT), "") for name in done]
    assert f"results are in {out}" in capsys.readouterr().out
    assert json.loads((out / "east" / "run.json").read_text())["recording"] == str(videos[0])


def test_a_second_run_continues_and_takes_only_what_changed(videos, tmp_path, done, capsys):
    words = ("run", tmp_path / "*.avi", *PF, "-o", tmp_path / "all")
    assert follow(*words) == 0
    before = contents(tmp_path / "all")
    shutil.rmtree(tmp_path / "all" / "west")
    write_video(videos[1], map(frame_of, range(COUNT - 2)))
    done.clear()
    assert follow(*words) == 0
    assert done == ["north", "west"]
    assert "1 of 3 sources were done before" in capsys.readouterr().err
    after = contents(tmp_path / "all")
    same = {name for name in before if before[name] == after[name]}
    assert {name for name in before if not name.startswith("north")} - {"sources.csv"} <= same
    assert table(tmp_path / "all")[1]["frames"] == str(COUNT - 2)
    done.clear()
    assert follow(*words, "--seed", 3) == 0
    assert follow(*words, "--seed", 3, "--overwrite") == 0
    assert done == ["east", "north", "west"] * 2


def test_a_bad_source_costs_itself_only(videos, tmp_path, done, capsys):
    videos[1].write_bytes(b"no video")
    words = ("run", *videos, *PF, "-o", tmp_path / "all")
    assert follow(*words) == 1
    error = capsys.readouterr().err
    assert "error: north: " in error
    assert "Traceback" not in error
    rows = table(tmp_path / "all")
    assert [bool(row["failed"]) for row in rows] == [False, True, False]
    assert [row["tracked"] for row in rows] == [str(COUNT), "", str(COUNT)]
    done.clear()
    assert follow(*words) == 1  # tried again, as a share may have been away
    assert done == ["north"]


def test_a_fault_of_ours_is_that_sources_failure(videos, tmp_path, done, monkeypatch, capsys):
    def open_or_fail(source, **options):
        assert "east" not in source
        return open_source(source, **options)

    monkeypatch.setattr(run_verb, "open_source", open_or_fail)
    assert follow("run", *videos, *PF, "-o", tmp_path / "all") == 1
    assert "east: it ended with an internal error: AssertionError" in capsys.readouterr().err
    assert (tmp_path / "all" / "west" / "estimates.csv").exists()


def test_a_list_has_options_of_each_source(videos, tmp_path, done):
    first, second = f"east.avi --target {TARGET}  # red", "west.avi --target 12,24,16,12"
    (tmp_path / "cameras.txt").write_text(f"# two cameras\n\n{first}\n{second}\n")
    words = ("run", tmp_path / "cameras.txt", "--variant", "ms", *OPENCV, "-o", tmp_path / "all")
    assert follow(*words, "--end", "5") == 0
    boxes = [
        json.loads(path.read_text())["target"] for path in sorted(tmp_path.glob("all/*/run.json"))
    ]
    assert boxes == [[8, 24, 16, 12], [12, 24, 16, 12]]
    assert [row["frames"] for row in table(tmp_path / "all")] == ["5", "5"]


def test_an_option_of_a_line_holds_though_it_is_the_default(videos, tmp_path, done):
    (tmp_path / "cams.txt").write_text("east.avi --variant fusion\nnorth.avi\n")
    assert follow("run", tmp_path / "cams.txt", *PF, "-o", tmp_path / "out") == 0
    runs = [json.loads((tmp_path / "out" / one / "run.json").read_text()) for one in done]
    assert [one["variant"] for one in runs] == ["fusion", "pf"]


def test_several_targets_have_a_row_each(videos, tmp_path, done):
    target = ("--target", f"a@1:{TARGET}", "--target", f"b@1:{TARGET}", "--variant", "ms", *OPENCV)
    assert follow("run", *videos[:2], *target, "-o", tmp_path / "all") == 0
    assert [row["source"] for row in table(tmp_path / "all")] == [
        "east/a", "east/b", "north/a", "north/b",
    ]  # fmt: skip


def test_recordings_have_their_scores_in_the_table(tmp_path, done):
    paths = [record(tmp_path / name) for name in ("one", "two")]
    assert follow("run", *paths, "--variant", "ms", *OPENCV, "-o", tmp_path / "all") == 0
    assert [float(row["on_target"]) for row in table(tmp_path / "all")] == [1.0, 1.0]


def test_traffic_counts_over_all_sources(videos, tmp_path, done, capsys):
    (tmp_path / "lines.yaml").write_text("lines: {exit: {from: [40, 0], to: [40, 63]}}")
    boxes = "".join(f"{n + 1},-1,{8 + 2 * n},24,16,12,0.9,-1,-1,-1\n" for n in range(COUNT))
    (tmp_path / "det.txt").write_text(boxes)
    given = ("--detections", tmp_path / "det.txt", "--lines", tmp_path / "lines.yaml")
    assert follow("traffic", *videos, *given, "-o", tmp_path / "all") == 0
    rows = table(tmp_path / "all")
    assert [row["vehicles"] for row in rows] == ["1", "1", "1"]
    assert (tmp_path / "all" / "west" / "tracks.csv").exists()
    total = next(line for line in capsys.readouterr().out.splitlines() if "all " in line)
    assert f" {3 * COUNT} " in total


def killed(request):
    """Stand-in of `run_one` that a decoder ends in the middle of one of the sources."""
    if "north" in request.source:
        os.kill(os.getpid(), signal.SIGSEGV)
    return run_verb.run_one(request)


def test_a_decoder_that_ends_its_process_costs_its_source_only(
    videos, tmp_path, monkeypatch, capsys
):
    out = tmp_path / "all"
    monkeypatch.setattr(run_verb, "run_one", killed)
    assert follow("run", *videos, *PF, "--workers", 2, "-o", out) == 1
    (error,) = [line for line in capsys.readouterr().err.splitlines() if "SIGSEGV" in line]
    assert "north: its process was ended by SIGSEGV" in error
    for name in ("east", "west"):
        assert (out / name / "estimates.csv").exists()
    monkeypatch.undo()
    assert follow("run", *videos, *PF, "--workers", 1, "-o", out) == 0
    assert "2 of 3 sources were done before" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("east.avi", "east.avi"), "several sources would be called"),
        (("east.avi", "0"), "the camera 0 has no end; give it a command of its own"),
        (("nothing*.avi",), "no source is called as nothing"),
        (("east.avi", "west.avi", "--set", "nope=1"), "nope"),
        (("east.avi", "west.avi", "--serve"), "--serve shows one source"),
        (("empty.txt",), "the list empty.txt names no source"),
        (("bad.txt",), "line 2 of bad.txt: "),
        (("pair.txt",), "line 1 of pair.txt has more than one source"),
    ],
)
def test_a_mistake_is_told_before_the_first_source(
    words, sentence, videos, tmp_path, done, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty.txt").write_text("# nothing\n")
    (tmp_path / "bad.txt").write_text("east.avi\nwest.avi --nope 3\n")
    (tmp_path / "pair.txt").write_text("east.avi west.avi\n")
    assert follow("run", *words, "-o", "all") in {1, 2}
    assert sentence in capsys.readouterr().err
    assert done == []


def test_many_sources_need_a_folder(videos, done, capsys):
    assert follow("run", *videos) == 2
    assert "give it with -o DIR" in capsys.readouterr().err


def test_processes_here_give_the_same(videos, tmp_path, done, monkeypatch):
    words = ("run", *videos[:2], *PF)
    assert follow(*words, "-o", tmp_path / "one") == 0
    monkeypatch.undo()
    assert follow(*words, "--workers", 2, "-o", tmp_path / "two") == 0
    assert contents(tmp_path / "one") == contents(tmp_path / "two")


def test_a_cluster_gives_the_same_though_a_worker_is_killed(
    videos, tmp_path, done, monkeypatch, capsys
):
    words = ("run", *(f"file://{video}" for video in videos), *PF)
    assert follow(*words, "-o", tmp_path / "here") == 0
    followed = []
    with (
        scheduler(tmp_path / "scheduler") as (address, _),
        workers(address, tmp_path, 2) as children,
    ):

        def kill_one(*given, **settings):
            for job, outcome in cluster.run_on_cluster(*given, **settings):
                followed.append(job.name)
                children[0].kill()
                yield job, outcome

        monkeypatch.setattr(many_sources, "run_on_cluster", kill_one)
        assert follow(*words, "--scheduler", address, "-o", tmp_path / "there") == 0
    assert sorted(followed) == ["east", "north", "west"]
    assert contents(tmp_path / "here") == contents(tmp_path / "there")
    assert "2 workers on 1 machine; the dashboard is http" in capsys.readouterr().err
    # Nothing is left to do, and nobody is asked.
    assert follow(*words, "--scheduler", "tcp://127.0.0.1:1", "-o", tmp_path / "there") == 0
