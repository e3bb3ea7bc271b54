# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The client and its worker, on MIL, the baseline that every OpenCV has."""

import ast
import shlex
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation import baseline_process as client
from vehicle_pf_tracker.evaluation import baseline_worker as worker
from vehicle_pf_tracker.evaluation.baseline_process import (
    BASELINES_VARIABLE,
    DEFAULT_INTERPRETER,
    baseline_python,
    install_command,
)
from vehicle_pf_tracker.evaluation.baselines import (
    BASELINE_MODELS,
    Baseline,
    BaselineAnswer,
    baseline_rows,
)

PYTHON = Path(sys.executable)
TARGET = Box(30, 40, 24, 20)


def frame_at(shift):
    """A red vehicle on grey noise, `shift` px to the right of where it starts."""
    frame = np.random.default_rng(3).integers(90, 120, (120, 160, 3), np.uint8)
    left = int(TARGET.x) + shift
    frame[40:60, left : left + 24] = (200, 30, 30)
    return frame


@pytest.fixture(scope="module")
def mil():
    with Baseline("mil", PYTHON) as baseline:
        yield baseline


def test_a_baseline_follows_the_vehicle_and_tells_its_cpu_time(mil):
    answers = [mil.start(frame_at(0), TARGET), *(mil.step(frame_at(2 * i)) for i in range(1, 6))]
    assert all(answer.found and answer.seconds > 0 for answer in answers)
    assert answers[0].box == TARGET
    assert np.hypot(*np.subtract(answers[-1].box.centre, (52, 50))) < 6


ECHO = """
import json, sys
print(json.dumps({"opencv": "none"}), flush=True)
while line := sys.stdin.buffer.readline():
    request = json.loads(line)
    pixels = sys.stdin.buffer.read(request["height"] * request["width"] * 3)
    box = request.get("box") or [pixels[0], pixels[1], pixels[2], sum(pixels)]
    print(json.dumps({"box": box, "seconds": 0}), flush=True)
"""


def test_frames_arrive_as_they_are_also_views_with_gaps(tmp_path, monkeypatch):
    script = tmp_path / "echo.py"
    script.write_text(ECHO)
    monkeypatch.setattr(client, "WORKER", script)
    wide = np.random.default_rng(1).integers(0, 256, (30, 80, 3), np.uint8)
    frame = wide[3:, 7:60]
    assert not frame.flags.c_contiguous
    with Baseline("csrt", PYTHON) as baseline:
        assert baseline.start(frame, Box(2.4, 2.6, 0.3, 7)).box == Box(2, 3, 1, 7)
        expected = Box(*map(float, frame[0, 0]), float(frame.sum(dtype=int)))
        assert baseline.step(frame).box == expected


def test_a_dead_worker_is_named(monkeypatch):
    started, start = [], subprocess.Popen
    monkeypatch.setattr(
        subprocess, "Popen", lambda *a, **k: started.append(start(*a, **k)) or started[-1]
    )
    with Baseline("mil", PYTHON) as baseline:
        started[-1].kill()
        started[-1].wait()
        with pytest.raises(InputError, match=r"the baseline mil, run by .* ended: status -9"):
            baseline.start(np.zeros((2000, 2000, 3), np.uint8), TARGET)


@pytest.mark.parametrize(
    ("name", "models", "words"),
    [
        ("boost", {}, "unknown baseline 'boost'; the baselines are csrt, kcf, mil, vit, nano"),
        ("csrt", {"net": "a.onnx"}, "csrt needs no model files; got net"),
        ("nano", {"backbone": "a.onnx"}, "model files: backbone, neckhead; got backbone"),
        (
            "vit",
            {"net": "absent.onnx"},
            "no file absent.onnx for the model net of the baseline vit",
        ),
    ],
)
def test_wrong_baselines_and_models_are_told_in_a_sentence(name, models, words):
    with pytest.raises(InputError, match=words):
        Baseline(name, PYTHON, {key: Path(path) for key, path in models.items()})


def test_every_baseline_of_the_client_is_known_to_the_worker():
    assert list(BASELINE_MODELS) == list(worker.OPENCV)


def test_an_opencv_without_the_tracker_is_named(monkeypatch):
    monkeypatch.delattr(cv2, "TrackerCSRT_create", raising=False)
    with pytest.raises(LookupError, match="has no TrackerCSRT; `make baselines` builds"):
        worker.tracker_maker(cv2, "csrt", {})


def test_an_environment_without_opencv_is_named(tmp_path):
    bare = tmp_path / "python"
    bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -S "$@"\n')  # -S: no site-packages
    bare.chmod(0o755)
    with pytest.raises(InputError, match=r"No module named 'numpy'; `make baselines` builds"):
        Baseline("mil", bare)


def test_the_interpreter_is_the_chosen_one_else_the_variables_else_the_default_else_the_caches(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(BASELINES_VARIABLE, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "my cache"))
    environment = "my cache/vehicle_pf_tracker/baselines"
    with pytest.raises(InputError, match=rf"no interpreter .*{BASELINES_VARIABLE}") as caught:
        baseline_python()
    assert f"`{install_command()}`" in str(caught.value)
    assert shlex.split(install_command())[3] == str(tmp_path / environment)
    assert Path(shlex.split(install_command())[-1]).is_file()
    monkeypatch.setenv(BASELINES_VARIABLE, "missing")
    with pytest.raises(InputError, match="no interpreter missing to run"):
        baseline_python()
    monkeypatch.delenv(BASELINES_VARIABLE)
    for name in (f"{environment}/bin/python", str(DEFAULT_INTERPRETER), "named", "chosen"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.symlink_to(sys.executable)
        if name not in ("named", "chosen"):
            assert baseline_python() == path  # and not what it links to
    monkeypatch.setenv(BASELINES_VARIABLE, "named")
    assert baseline_python() == tmp_path / "named"
    assert baseline_python(Path("chosen")) == tmp_path / "chosen"


def test_the_worker_needs_nothing_of_this_package():
    tree = ast.parse(Path(worker.__file__).read_text())
    names = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import)
             for alias in node.names}  # fmt: skip
    names |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    others = {name.partition(".")[0] for name in names} - set(sys.stdlib_module_names)
    assert others == {"cv2", "numpy", "trackers", "trackeval", "supervision"}


class GivesUp:
    """A baseline that loses its target in the second frame."""

    name = "stub"

    def start(self, _, box):
        return BaselineAnswer(box, found=True, seconds=0.002)

    def step(self, _):
        return BaselineAnswer(TARGET, found=False, seconds=0.003)


def test_rows_wait_for_the_first_truth_and_say_where_the_baseline_gave_up():
    frame = frame_at(0)
    frames = [(0, frame), (10**9, frame), (2 * 10**9, None), (3 * 10**9, frame)]
    rows = list(baseline_rows(GivesUp(), frames, Truth(10**9, TARGET, Occlusion.NONE)))
    assert [row.mode for row in rows] == ["WAITING", "TRACKING", "REJECTED", "LOST"]
    assert [row.frame for row in rows] == [1, 2, 3, 4]
    assert rows[3].position == TARGET.centre
    assert rows[3].step_ms == pytest.approx(3.0)


def test_rows_need_an_image_of_the_first_truth():
    with pytest.raises(InputError, match=r"no image is within 0.01 s of the first truth, at 5.000"):
        list(baseline_rows(GivesUp(), [(0, frame_at(0))], Truth(5 * 10**9, TARGET, Occlusion.NONE)))
