# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Outputs never take away an input, replace nothing unasked, and belong to one command."""

import contextlib
import errno
import os
import subprocess
import sys

import pytest
from small_recordings import COUNT, TARGET, frame_folder, frame_of, record, write_video

from vehicle_pf_tracker.cli import pick
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.showing import video_file

HOLD = """
import sys
from pathlib import Path
from vehicle_pf_tracker.core.outputs import Products, claimed
path = Path(sys.argv[2])
with claimed([Products(path) if sys.argv[1] == "folder" else path], [], overwrite=True):
    print("ready", flush=True)
    sys.stdin.read()
"""
CORNERS = ["0,0=0,0", "90,0=9,0", "90,60=9,6", "0,60=0,6"]
PAIRS = [word for pair in CORNERS for word in ("--pair", pair)]


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A working folder with a recording, a video, and a folder of images."""
    monkeypatch.chdir(tmp_path)
    drawn = {"targets": [{"name": "van", "box": list(map(int, TARGET.split(",")))}]}
    monkeypatch.setattr(pick, "ask", lambda *_: drawn)
    record(tmp_path / "bag")
    write_video(tmp_path / "clip.mp4", map(frame_of, range(COUNT)), codec="mp4v")
    frame_folder(tmp_path / "frames")
    return tmp_path


def content(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def other_names(path):
    """Make a symbolic and a hard link to a file; return them, and the file's own names."""
    path.with_name(f"soft{path.suffix}").symlink_to(path)
    os.link(path, path.with_name(f"hard{path.suffix}"))
    folder, name = path.parent, path.name
    return [name, str(path), f"../{folder.name}/{name}", f"soft{path.suffix}", f"hard{path.suffix}"]


def fails(words, sentence, capsys):
    assert main([str(word) for word in words]) == 1
    assert sentence in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["run", "clip.mp4", "--variant", "pf", "--target", TARGET, "-o", "out", "--video"],
        ["traffic", "clip.mp4", "-o", "out", "--video"],
        ["pick", "clip.mp4", "-o"],
        ["import", "clip.mp4"],
    ],
    ids=lambda words: words[0],
)
def test_a_source_is_no_output_by_any_name(here, capsys, words):
    before = (here / "clip.mp4").read_bytes()
    for name in other_names(here / "clip.mp4"):
        fails([*words, name, "--overwrite"], "would change the input clip.mp4", capsys)
        assert (here / "clip.mp4").read_bytes() == before


def test_a_link_as_a_source_protects_what_it_leads_to(here, capsys):
    *_, soft, hard = other_names(here / "clip.mp4")
    for name in (soft, hard):
        fails(["pick", name, "-o", "clip.mp4", "--overwrite"], "would change the input", capsys)


@pytest.mark.parametrize(
    "words",
    [
        ["run", "bag", "-o", "bag"],
        ["run", "bag/bag_0.mcap", "-o", "bag"],
        ["run", "bag", "-o", "out", "--recording", "bag"],
        ["run", "bag/bag_0.mcap", "-o", "out", "--recording", "bag"],
        ["run", "bag", "-o", "out", "--video", "bag/seen.mp4"],
        ["traffic", "bag", "-o", "linked"],
        ["pick", "frames", "-o", "frames/img/000001.jpg"],
        ["pick", "frames", "--grid", "frames/grid.png"],
        ["pick", "frames", "--grid", "hard.jpg"],
        ["road", "calibrate", "bag", *PAIRS, "--grid", "bag/grid.png"],
        ["evaluate", "bag", "--variants", "pf", "-o", "bag"],
        ["tune", "bag", "--variant", "pf", "-o", "bag"],
    ],
    ids=" ".join,
)
def test_the_folder_of_a_source_is_no_output(here, capsys, words):
    (here / "linked").symlink_to("bag")
    os.link("frames/img/000002.jpg", "hard.jpg")
    before = content(here)
    again = [] if words[0] in {"evaluate", "tune"} else ["--overwrite"]
    fails([*words, *again], "would change the input", capsys)
    assert content(here) == before


def test_files_of_options_are_inputs_too(here, capsys):
    (here / "pairs.yaml").write_text("pairs: [{pixel: [0, 0], road: [0, 0]}]")
    words = ["road", "calibrate", "bag", "--pairs", "pairs.yaml", "-o", "pairs.yaml"]
    fails([*words, "--overwrite"], "would change the input pairs.yaml", capsys)
    (here / "tuned").mkdir()
    (here / "tuned" / "best.yaml").write_text("pf_tracker: {ros__parameters: {sigma: 3.0}}")
    words = ["tune", "bag", "--variant", "pf", "--params", "tuned/best.yaml", "-o", "tuned"]
    fails(words, "would change the input tuned/best.yaml", capsys)


ONCE_MORE = {
    "run": ["run", "bag", "--variant", "pf", "-o", "out"],
    "run --video": ["run", "bag", "--variant", "pf", "-o", "NEW", "--video", "out.mp4"],
    "run --recording": ["run", "bag", "--variant", "pf", "-o", "NEW", "--recording", "out"],
    "traffic": ["traffic", "bag", "-o", "out"],
    "traffic --video": ["traffic", "bag", "-o", "NEW", "--video", "out.mp4"],
    "pick": ["pick", "bag", "-o", "out.yaml"],
    "pick --grid": ["pick", "bag", "--grid", "out.png"],
    "road -o": ["road", "calibrate", "bag", *PAIRS, "-o", "out.yaml"],
    "road --grid": ["road", "calibrate", "bag", *PAIRS, "--grid", "out.png"],
    "import": ["import", "frames", "out"],
    "synth": ["synth", "bar", "out", "--set", "speed=40", "--set", "width=0"],
}


@pytest.mark.parametrize("words", ONCE_MORE.values(), ids=ONCE_MORE)
def test_what_exists_is_replaced_on_request_only(here, capsys, words):
    first, second, third = ([word.replace("NEW", f"new{n}") for word in words] for n in range(3))
    assert main(first) == 0
    before = content(here)
    fails(second, "give --overwrite", capsys)
    assert content(here) == before
    assert main([*third, "--overwrite"]) == 0


def test_files_of_others_in_the_folder_are_in_nobody_s_way(here):
    (here / "notes.txt").write_text("mine")
    assert main(["run", "clip.mp4", "--variant", "pf", "--target", TARGET, "-o", "."]) == 0
    assert (here / "notes.txt").read_text() == "mine"


@pytest.fixture
def hold(here):
    """Hold an output in another process."""
    holders = []

    def start(kind, path):
        words = [sys.executable, "-c", HOLD, kind, str(path)]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        holders.append(subprocess.Popen(words, **pipes))
        assert holders[-1].stdout.readline() == "ready\n"
        return holders[-1]

    yield start
    for holder in holders:
        holder.kill()
        holder.communicate()


@pytest.mark.parametrize(
    ("kind", "out", "words"),
    [
        ("folder", "out", ["run", "bag", "--variant", "pf", "-o", "out"]),
        ("folder", "out", ["traffic", "bag", "-o", "out"]),
        ("folder", "out", ["evaluate", "bag", "--variants", "pf", "--seeds", "1", "-o", "out"]),
        ("folder", "out", ["tune", "bag", "--variant", "pf", "--trials", "1", "-o", "out"]),
        ("folder", "out", ["report", "out"]),
        ("path", "out", ["import", "frames", "out"]),
        ("path", "out", ["synth", "bar", "out"]),
        ("path", "out.mp4", ["synth", "bar", "out.mp4"]),
        ("path", "out.yaml", ["pick", "bag", "-o", "out.yaml"]),
        ("path", "out.png", ["road", "calibrate", "bag", *PAIRS, "--grid", "out.png"]),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else value,
)
def test_the_second_command_at_one_output_is_refused(hold, capsys, kind, out, words):
    hold(kind, out)
    fails(words, "another command is at work in", capsys)


def test_a_lock_ends_with_its_process(hold, here):
    holder = hold("folder", "out")
    holder.kill()
    holder.wait()
    assert (here / "out" / ".lock").exists()
    assert main(ONCE_MORE["run"]) == 0
    assert not (here / "out" / ".lock").exists()


@pytest.mark.parametrize("good", [1, 4, COUNT], ids=["first", "middle", "end"])
@pytest.mark.parametrize(
    ("words", "table"),
    [(("run", "--target", TARGET), "estimates.csv"), (("traffic",), "tracks.csv")],
)
def test_a_disk_that_fills_costs_the_video_and_nothing_else(
    here, monkeypatch, capsys, words, table, good
):
    @contextlib.contextmanager
    def filling(path, size, rate):
        path.write_bytes(b"begun")
        count = 0

        def write(frame, at):
            nonlocal count
            count += 1
            if count > good:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        yield write
        write(None, 0)

    monkeypatch.setattr(video_file, "h264_writer", filling)
    verb, *options = words
    assert main([verb, "clip.mp4", *options, "-o", "whole"]) == 0
    assert main([verb, "clip.mp4", *options, "-o", "out", "--video", "full/v.mp4"]) == 1
    told = capsys.readouterr()
    assert "full/v.mp4: No space left on device; all else is written" in told.err
    assert "the video is" not in told.out
    assert not (here / "full").exists()
    kept, whole = ((here / name / table).read_text().splitlines() for name in ("out", "whole"))
    assert len(kept) == len(whole)
    assert (here / "out" / "run.json").is_file()


def test_a_disk_that_fills_leaves_no_truth_of_a_video_that_is_not_there(here, monkeypatch, capsys):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(video_file, "h264_writer", full)
    assert main(["synth", "bar", "full/bar.mp4"]) == 1
    assert "cannot write full/bar.mp4: No space left on device" in capsys.readouterr().err
    assert not (here / "full").exists()
