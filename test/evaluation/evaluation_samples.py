# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A small grid: two recordings of a vehicle, one hidden for a while; run in this process."""

import csv
import json
from dataclasses import replace

from drive import box_of, frame_of, stamp_of

from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.grid.cells import Plan
from vehicle_pf_tracker.evaluation.grid.running import complete, run_cell
from vehicle_pf_tracker.evaluation.grid.sources import describe_recordings
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import from_mapping, to_mapping
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.output_files import write_json
from vehicle_pf_tracker.trackers.registry import find_variant

FRAMES = 36
HIDDEN = {"bridge": range(8, 14), "free": range(0)}
VARIANTS = ("pf", "ms", "apf")
SEEDS = (0, 1)
ALONE = {"ms": SEEDS[:1]}
"""Seeds of those that draw nothing."""
NO_BASELINES = "the environment of the baselines is not there; make it with `make baselines`"
NOT_DECIDED_BY_THE_INPUT = ("step_ms", "step_ms_p50", "step_ms_p95", "made", "command")


def make_evaluation(folder):
    """Make the folder's `evaluation`, and the recordings beside it; returns the former."""
    made = folder / "evaluation"
    systems = [*map(system, VARIANTS), System.of_baseline("csrt", str(folder / "none"))]
    complete(make_plan(write_recordings(folder), systems, SEEDS), made, here, silent)
    for path in made.rglob("failed.json"):
        write_json(path, {"reason": NO_BASELINES})
    return made


def write_recording(path, hidden=range(0)):
    path.parent.mkdir(parents=True, exist_ok=True)
    with RecordingWriter(path) as writer:
        for index in range(FRAMES):
            frame = frame_of(index)
            occlusion = Occlusion.NONE
            if index in hidden:
                frame[20:40] = 70
                occlusion = Occlusion.TOTAL
            writer.write_image(stamp_of(index), frame)
            writer.write_truth(Truth(stamp_of(index), box_of(index), occlusion))
    return path


def write_recordings(folder):
    return [write_recording(folder / name, hidden) for name, hidden in HIDDEN.items()]


def system(name, label=None, **changed):
    kind = find_variant(name).parameters
    if "num_particles" in to_mapping(kind()):
        changed = {"num_particles": 40, **changed}
    values = {**to_mapping(from_mapping(kind, changed)), **to_mapping(SessionParameters())}
    own = [(n, v) for n, v in values.items() if n != "seed" and not n.startswith("target.")]
    made = System.of_variant(name, tuple(own), "", tuple(changed.items()))
    return replace(made, label=label or name)


def make_plan(paths, systems=None, seeds=SEEDS):
    described = dict(describe_recordings([str(path) for path in paths], None, 0.01))
    systems = [system("pf"), system("ms")] if systems is None else systems
    command = ["vehicle-pf-tracker", "evaluate", "free", "-o", "evaluation"]
    return Plan(described, systems, seeds, command)


def here(cells):
    """Run cells in this process, one after the other."""
    for cell in cells:
        yield cell, run_cell(cell)


def silent(done, total):
    pass


def results(folder):
    """Everything in an evaluation's folder that the input decides, by path."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.name in {"estimates.csv", "restarted.csv"}:
            rows = list(csv.DictReader(path.open()))
            found[name] = [{k: v for k, v in row.items() if k != "step_ms"} for row in rows]
        elif path.suffix == ".json":
            document = json.loads(path.read_text())
            left = {k: v for k, v in document.items() if k not in NOT_DECIDED_BY_THE_INPUT}
            found[name] = left
        elif path.is_file():
            found[name] = path.read_bytes()
    return found
