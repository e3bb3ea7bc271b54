# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every program outside of the package runs on a toy input, and writes what it is there for.

Those that .ci/run starts itself are left out: `make bench BENCH_ARGS=--toy`, `benchmarks.versus`.
"""

import json
import subprocess
import sys
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import cv2
import pytest
from unmeasured import unmeasured_environment

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.mot_folder import write_mot_folder
from reproduction.catalogue import EXPERIMENTS
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.baseline_process import BASELINES_VARIABLE, baseline_python
from vehicle_pf_tracker.scenes.catalogue import make_scene

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 1800
"""Seconds until a program counts as hung: the experiments take minutes on a busy core."""
FRAMES = 60
"""Frames of a toy sequence: painted occluders need a second before them and one after."""
PICTURE = "fusion_turn"
FAST_PNG = (cv2.IMWRITE_PNG_COMPRESSION, 1)


class Program(NamedTuple):
    """Words after the module's name, what it writes into `{out}`, what it prints, what it needs."""

    words: str
    files: tuple[str, ...] = ()
    printed: str = ""
    needs: tuple[str, ...] = ()


BATTERY = "{toy}/sequences --workers 1 -o {out}"
ONE_CASE = "--seeds 1 --hard 1"
PROGRAMS = {
    "laboratory.count_trust": Program(
        "toy={toy}/traffic=good,motion two={toy}/traffic=good@.2 -o {out}",
        ("calibration.md", "left_out.md", "runs.jsonl"),
    ),
    "laboratory.fusion.ablation": Program(
        f"{BATTERY} --changes no~camera~motion",
        ("ablation.md", "ablation.jsonl"),
        "| no camera motion |",
    ),
    "laboratory.fusion.clips": Program(
        "{toy}/clip.mp4 {toy}/clip --model none -o {toy}/seen",
        printed="| all | 10 |",  # one of each clip, and eight look-alikes
    ),
    "benchmarks.fusion_cost": Program(
        "{toy}/sequences --frames 12 --resampled one -o {out}",
        ("cost.md", "cost.json"),
        needs=("baselines",),
    ),
    "benchmarks.first_answer": Program(
        "--kinds floor --rounds 1", printed="| floor |", needs=("rclpy",)
    ),
    "benchmarks.memory_parts": Program("", printed="| kernels and step of `apf` | +"),
    "laboratory.fusion.fit": Program(
        f"{BATTERY} {ONE_CASE} --budget 2 --cases 1", ("fit.json", "leave_one_camera_out.md")
    ),
    "laboratory.fusion.mechanisms": Program(
        f"{BATTERY} --seeds 1 --kinds plain --without no~flank",
        ("mechanisms.md", "mechanisms.jsonl"),
        "| no flank |",
    ),
    "laboratory.fusion.reliability": Program(
        f"{BATTERY} {ONE_CASE}", ("shipped.md", "reliability.md", "reliability.png")
    ),
    "laboratory.fusion.scene_pictures": Program(f"{{out}} --only {PICTURE}", (f"{PICTURE}.webp",)),
    "laboratory.fusion.scenes": Program("--scenes bridge --seeds 1 -o {out}/a.md", ("a.md",)),
    "laboratory.readme_table": Program(
        f"{BATTERY} {ONE_CASE} --budget 2 --cases 1", ("readme.md",), "| `fusion` as it ships | "
    ),
    "laboratory.road_speed": Program(
        "--seeds 1 --speeds 130 --variant apf -o {out}/a.md", ("a.md",), "| all | pairs |"
    ),
    "laboratory.target_contrast": Program("{toy}/sequences", printed="| one |"),
    "laboratory.train_sides": Program(
        "{toy}/sequences/toy {toy}/clip -o {out}/sides.npz --parts {out}/parts",
        ("sides.npz", "parts/3.npz", "parts/cameras.csv"),
        "| left or right | ",
    ),
    "laboratory.traffic.clips": Program(
        "{toy}/clip.mp4 0 {toy}/clip/groundtruth.csv --seeds 1", printed="| clip | 0 |"
    ),
    "benchmarks.traffic_cost": Program(
        "--rounds 1 --counts 1 3 --frames 62",
        printed="per further vehicle",
        needs=("baselines",),
    ),
    "laboratory.traffic.fit": Program(
        "toy={toy}/traffic --boxes good --only trackers.traffic.misses:_MISSED -o {out}",
        ("leave_one_camera_out.md", "runs.jsonl"),
        needs=("baselines",),
    ),
    "laboratory.traffic.joined": Program("toy={toy}/traffic", printed="| traffic |"),
    "laboratory.traffic.occluders": Program("{toy}/traffic", printed="traffic: "),
    "laboratory.traffic.perturbed": Program(
        "{toy}/traffic -o {out}", ("traffic.md",), "the report is", ("baselines",)
    ),
    "laboratory.traffic.score": Program(
        "{toy}/traffic --baselines", printed="bytetrack", needs=("baselines",)
    ),
    "laboratory.traffic.spread": Program(
        "{toy}/traffic --runs 1 --frames 40", printed="| traffic", needs=("baselines",)
    ),
}
LIBRARIES = {
    "laboratory.fusion.case_lists", "laboratory.fusion.objective", "laboratory.fusion.options",
    "laboratory.fusion.score_table", "laboratory.fusion.settings",
    "laboratory.traffic.camera_clips", "laboratory.traffic.decision_table",
    "laboratory.traffic.decisions", "laboratory.traffic.trials",
    "laboratory.__init__", "laboratory.fusion.__init__", "laboratory.traffic.__init__",
    "laboratory.__main__", "laboratory.figure_files", "laboratory.result_store",
    "laboratory.side_examples", "laboratory.side_training",
    "laboratory.uncertainty.__init__", "laboratory.uncertainty.coverage",
    "laboratory.uncertainty.fit", "laboratory.uncertainty.picture", "laboratory.uncertainty.runs",
    "laboratory.uncertainty.table_module", "laboratory.uncertainty.tracking",
    "benchmarks.versus", "benchmarks.versus_worker",
}  # fmt: skip
"""Modules that the programs import, and what .ci/run starts."""


def write_sequence(folder, shots):
    """Write frames at half their size, with their truth, as a frame folder."""
    (folder / "img").mkdir(parents=True)
    lines = ["frame,x,y,w,h,visible,occ"]
    for number, each in enumerate(shots, start=1):
        box, occlusion = each.truth.box, int(each.truth.occlusion)
        sides = ",".join(f"{side / 2}" for side in (box.x, box.y, box.width, box.height))
        lines.append(f"{number},{sides},{int(occlusion < 2)},{occlusion}")
        image = cv2.resize(each.frame[..., ::-1], None, fx=0.5, fy=0.5)
        cv2.imwrite(str(folder / "img" / f"{number:04d}.png"), image, FAST_PNG)
    (folder / "groundtruth.csv").write_text("\n".join(lines) + "\n")
    (folder / "sequence.json").write_text(json.dumps({"fps": 15.0}))


@pytest.fixture(scope="module")
def toy(tmp_path_factory):
    """Folder of two sequences, a clip with truth and a traffic scene."""
    folder = tmp_path_factory.mktemp("toy")
    one, two = (
        list(islice(make_scene("bridge", seed=seed).frames(), count))
        for seed, count in enumerate((90, FRAMES))
    )
    for name, shots in (("one", one), ("two", two)):
        write_sequence(folder / "sequences" / "toy" / name, shots[:FRAMES])
    write_sequence(folder / "clip", one)  # with the whole occlusion, which is judged
    images = [cv2.imread(str(path)) for path in sorted((folder / "clip" / "img").iterdir())]
    size = images[0].shape[1::-1]
    writer = cv2.VideoWriter(str(folder / "clip.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), 15.0, size)
    for image in images:
        writer.write(image)
    writer.release()
    (folder / "seen" / "clip").mkdir(parents=True)
    rows = [f"{time + 1},1,{size[0] - 140 + 4 * time},90,20,15,0.9" for time in range(35)]
    seen = "\n".join(["frame,id,x,y,width,height,score", *rows])
    (folder / "seen" / "clip" / "tracks.csv").write_text(seen)  # in place of `traffic`'s
    scene = make_traffic_scene("traffic-pair", settings={"frames": 50})
    write_mot_folder(scene, folder / "traffic", 0)
    for detector in (folder / "traffic" / "det").iterdir():
        if detector.stem != "good":
            detector.unlink()  # the programs run every detector
    return folder


def run(module, *words):
    done = subprocess.run(
        [sys.executable, "-m", module, *words],
        cwd=ROOT,
        env={**unmeasured_environment(), "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def skip_without(needs):
    if "rclpy" in needs:
        pytest.importorskip("rclpy", reason="ROS is not installed")
    if "baselines" in needs:
        try:
            baseline_python(None)
        except InputError:
            pytest.skip(f"no baselines: `make baselines`, or set {BASELINES_VARIABLE}")


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_writes_its_output(name, toy, tmp_path):
    program = PROGRAMS[name]
    skip_without(program.needs)
    words = [word.format(toy=toy, out=tmp_path).replace("~", " ") for word in program.words.split()]
    printed = run(name, *words)
    assert program.printed in printed
    for file in program.files:
        assert (tmp_path / file).stat().st_size > 0


def test_covariances_are_fitted_and_reported(tmp_path):
    runs = str(tmp_path / "runs")
    (tmp_path / "images").mkdir()
    options = "--seeds", "1", "--scenes", "bridge", "--variants", "apf", "fusion"
    run("laboratory.uncertainty", "run", runs, *options)
    table = tmp_path / "table.py"
    run("laboratory.uncertainty", "fit", runs, "--table", str(table))
    assert "CALIBRATIONS" in table.read_text()
    assert "| `apf` |" in run("laboratory.uncertainty", "report", runs, "--docs", str(tmp_path))
    assert (tmp_path / "images" / "uncertainty.png").stat().st_size > 0


def test_every_program_is_tried():
    rooms = ("fusion", "traffic", "uncertainty")
    folders = "benchmarks", "laboratory", *(f"laboratory.{room}" for room in rooms)
    there = {
        f"{folder}.{path.stem}"
        for folder in folders
        for path in (ROOT / folder.replace(".", "/")).glob("*.py")
    }
    assert {*PROGRAMS, "laboratory.uncertainty.__main__"} == there - LIBRARIES


def test_every_experiment_is_reproduced(tmp_path):
    run("reproduction", "all", "--quick", "--seeds", "1", "-o", str(tmp_path))
    for name in EXPERIMENTS:
        assert {path.name for path in (tmp_path / name).iterdir()} == {
            "data.csv", "figure.svg", "figure.png", "verdict.json", "verdict.md",
        }  # fmt: skip
        verdict = json.loads((tmp_path / name / "verdict.json").read_text())
        assert all(claim["findings"] for claim in verdict["claims"])
