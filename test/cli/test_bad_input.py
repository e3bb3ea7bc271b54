# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Each mistake gives one clear sentence and a status that is not 0, and never a traceback."""

from pathlib import Path

import pytest
from small_recordings import (
    TARGET,
    frame_folder,
    record,
    record_two_cameras,
    record_without_images,
)

from vehicle_pf_tracker.cli.main import main


@pytest.fixture
def bag(tmp_path):
    return record(tmp_path / "bag")


@pytest.fixture
def fails(capsys):
    """Call the command, and return its only line on stderr."""

    def call(*words, status=1):
        assert main([str(word) for word in words]) == status
        out, err = capsys.readouterr()
        assert out == ""
        # A slow machine shows progress too.
        (line,) = [one for one in err.splitlines() if not one.startswith("tracked ")]
        assert line.startswith("vehicle-pf-tracker: error: ")
        return line

    return call


@pytest.fixture
def run_fails(fails, tmp_path):
    """Call `run` into a folder, which must not hold results afterwards."""

    def call(recording, *words, variant="apf", status=1):
        out = tmp_path / "out"
        line = fails("run", recording, "--variant", variant, "-o", out, *words, status=status)
        assert not out.exists() or not any(out.iterdir())
        return line

    return call


@pytest.fixture
def sources(bag, tmp_path):
    """The folder of sources, most of which cannot be tracked in."""
    (tmp_path / "text.mcap").write_text("This is no recording, however long it goes on.\n" * 100)
    (tmp_path / "empty.mcap").touch()
    (tmp_path / "empty").mkdir()
    cut = record(tmp_path / "cut") / "cut_0.mcap"
    cut.write_bytes(cut.read_bytes()[:200])
    record_without_images(tmp_path / "blind")
    record_two_cameras(tmp_path / "two")
    record(tmp_path / "untrue", truths=())
    return tmp_path


@pytest.mark.parametrize(
    ("source", "words", "message"),
    [
        ("none", (), "none"),
        ("text.mcap", (), "text.mcap"),
        ("empty.mcap", (), "empty.mcap"),
        ("empty", (), "empty"),
        ("cut", (), "truncated"),
        ("blind", (), "has no images"),
        ("two", ("--target", TARGET), "choose one with --topic: /left/image, /right/image"),
        ("bag", ("--topic", "/other"), "has no topic /other"),
        ("bag", ("--topic", "/ground_truth/box"), "carries geometry_msgs/msg/PolygonStamped"),
        ("bag", ("--target", "500,500,20,20"), "500,500,20,20 has its centre outside the image of"),
        ("bag", ("--target", "8,24,0,0"), "smaller than one pixel"),
        ("bag", ("--target", "8,24,16,0.5"), "smaller than one pixel"),
        ("bag", ("--target=8,24,-16,12",), "smaller than one pixel"),
        ("bag", ("--target=-5e8,-5e8,1e9,1e9",), "far larger than the image"),
        ("bag", ("--variant", "kalman"), "no variant 'kalman'"),
        ("bag", ("--seed", "-2"), "seed must be from -1"),
        ("bag", ("--params", "none.yaml"), "cannot read the parameter file none.yaml"),
        ("bag", ("--set", "road.pairs=0,0=0,0"), "at least 4 pairs"),
        ("untrue", ("--max-diff", "-1", "--target", TARGET), "seconds >= 0"),
    ],
)
def test_a_run_that_cannot_begin(run_fails, sources, source, words, message):
    assert message in run_fails(sources / source, *words)


@pytest.mark.parametrize("target", ["1,2,3", "1,2,3,4,5", "a,b,c,d", "nan,1,2,3", ""])
def test_a_target_that_is_none_is_wrong_usage(capsys, bag, tmp_path, target):
    words = ["run", str(bag), "--variant", "apf", "-o", str(tmp_path), f"--target={target}"]
    assert main(words) == 2
    assert "argument --target" in capsys.readouterr().err.splitlines()[-1]


def test_no_target_is_known(run_fails, tmp_path):
    line = run_fails(record(tmp_path / "bag", truths=()), status=2)
    assert "no truth to start on" in line
    assert "--target x,y,w,h" in line


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("num_particels=5", "no parameter 'num_particels' (did you mean 'num_particles'?)"),
        ("num_particles", "--set expects name=value, got 'num_particles'"),
        ("num_particles=many", "num_particles must be an integer, got 'many'"),
        ("num_particles=0", "num_particles must be from 1 to 100000, got 0"),
        ("motion.sigma_w=nan", "motion.sigma_w must be finite"),
        ("resampling=magic", "resampling must be one of"),
        ("evidence.occluded_below=0.9", "must not be above"),
        ("queue_depth=5", "no parameter 'queue_depth'"),
    ],
)
def test_a_parameter_that_does_not_fit(run_fails, bag, assignment, message):
    assert message in run_fails(bag, "--set", assignment)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("num_particels: 5", "no parameter 'num_particels' (did you mean 'num_particles'?)"),
        ("que_depth: 5", "no parameter 'que_depth' (did you mean 'queue_depth'?)"),
        ("num_particles: many", "num_particles must be an integer, got 'many'"),
        ("num_particles: 2.5", "num_particles must be an integer, got 2.5"),
        ("num_particles: true", "num_particles must be an integer, got True"),
        ("num_particles: 0", "num_particles must be from 1 to 100000, got 0"),
        ("queue_depth: 0", "queue_depth must be from 1"),
        ("motion: {sigma_w: [1]}", "motion.sigma_w must be a number, got [1]"),
        ("seed: ", "seed must be an integer, got None"),
    ],
)
def test_a_parameter_file_that_does_not_fit(run_fails, bag, tmp_path, text, message):
    path = tmp_path / "mine.yaml"
    path.write_text(f"/**:\n  ros__parameters:\n    {text}\n")
    line = run_fails(bag, "--params", path)
    assert message in line
    assert str(path) in line


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [1", "is not valid YAML"),
        ("num_particles: 5", "has no ros__parameters section"),
        ("pf_tracker:\n  ros__parameters:\n    seed: 1", "has nothing for apf_tracker"),
        ("", "has no ros__parameters section"),
    ],
)
def test_a_file_that_is_no_parameter_file(run_fails, bag, tmp_path, text, message):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    assert message in run_fails(bag, "--params", path)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--set", "with=60"], "no setting 'with'"),
        (["--set", "width=wide"], "width must be a number, got 'wide'"),
        (["--set", "width=1000"], "width must be from 0 to 120"),
        (["--seed", "-1"], "seed"),
    ],
)
def test_a_scene_setting_that_does_not_fit(fails, tmp_path, words, message):
    assert message in fails("synth", "bar", tmp_path / "out", *words)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "told", "status"),
    [
        (("runn", "x"), "no verb 'runn' (did you mean 'run'?); the verbs are demo, import", 2),
        (("dance",), "there is no verb 'dance'; the verbs are demo, import", 2),
        (("synth",), "synth needs SCENE and OUT", 2),
        (("synth", "traffic-forty", "out"), "`python -m laboratory.scenes SCENE OUT`", 1),
        (("synth", "moon", "out"), "no scene 'moon'; choose one of bar, ", 1),
        (("synth", "bar", "."), "is not empty; give --overwrite", 1),
        (("import", "none.mp4", "out"), "none.mp4", 1),
        (("import", "notes.mp4", "out"), "notes.mp4", 1),
        (("synth", "bars2", "out"), "no scene 'bars2' (did you mean 'bars'?)", 1),
        (("synth", "bar", "out", "--set", "widht=3"), "setting 'widht' (did you mean 'width'?)", 1),
        (("params", "mfps"), "no variant 'mfps' (did you mean 'mfpf'?)", 1),
    ],
)
def test_other_mistakes_leave_nothing(fails, tmp_path, monkeypatch, words, told, status):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "notes.mp4").write_text("no video")
    assert told in fails(*words, status=status)
    assert not (tmp_path / "out").exists()


def test_a_file_for_another_variant_is_named_as_such(run_fails, bag, tmp_path):
    path = tmp_path / "theirs.yaml"
    path.write_text("/**:\n  ros__parameters:\n    sigma: 0.2\n    num_particles: 50\n")
    line = run_fails(bag, "--params", path)
    assert "there is no parameter 'sigma'" in line
    assert "it is a file for pf" in line


NOWHERE = "/proc/nowhere"
"""A place where nothing can be made, not even by root."""


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="Linux has such a place")
@pytest.mark.parametrize(
    "words",
    [
        ("run", "BAG", "--variant", "pf", "-o", f"{NOWHERE}/out"),
        ("run", "BAG", "--variant", "pf", "-o", "OUT", "--video", f"{NOWHERE}/out.mp4"),
        ("run", "BAG", "--variant", "pf", "-o", "OUT", "--recording", f"{NOWHERE}/out"),
        ("import", "FRAMES", f"{NOWHERE}/out"),
        ("synth", "bar", f"{NOWHERE}/out"),
        ("synth", "bar", f"{NOWHERE}/out.mp4"),
        ("pick", "BAG", "--grid", f"{NOWHERE}/out.png"),
        ("evaluate", "BAG", "--variants", "pf", "-o", f"{NOWHERE}/out"),
    ],
    ids=" ".join,
)
def test_an_output_where_nothing_can_be_made(bag, tmp_path, capsys, words):
    places = {"BAG": bag, "FRAMES": frame_folder(tmp_path / "frames"), "OUT": tmp_path / "out"}
    assert main([str(places.get(word, word)) for word in words]) == 1
    *_, line = capsys.readouterr().err.splitlines()
    assert line.startswith("vehicle-pf-tracker: error: ")
    assert "cannot write" in line
    assert NOWHERE in line
    assert not places["OUT"].exists() or not list(places["OUT"].iterdir())
