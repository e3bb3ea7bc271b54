# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A small grid: two recordings of a vehicle, one hidden for a while; run in this process."""

import csv
import json

from drive import box_of, frame_of, stamp_of

from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.grid.cells import VariantSystem
from vehicle_pf_tracker.evaluation.grid.plan import Plan
from vehicle_pf_tracker.evaluation.grid.sources import describe
from vehicle_pf_tracker.evaluation.grid.tracking import run_cell
from vehicle_pf_tracker.offline.processes import Turn
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import from_mapping, to_mapping
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.trackers.registry import find_variant

FRAMES = 24
HIDDEN = {"bridge": range(8, 14), "free": range(0)}
NOT_DECIDED_BY_THE_INPUT = ("step_ms", "step_ms_p50", "step_ms_p95", "made", "command")


def write_recording(path, hidden=range(0), frames=FRAMES):
    path.parent.mkdir(parents=True, exist_ok=True)
    with RecordingWriter(path) as writer:
        for index in range(frames):
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
        changed = {"num_particles": 30, **changed}
    values = {**to_mapping(from_mapping(kind, changed)), **to_mapping(SessionParameters())}
    own = [(n, v) for n, v in values.items() if n != "seed" and not n.startswith("target.")]
    return VariantSystem(label or name, name, "", tuple(changed.items()), tuple(own))


def make_plan(paths, systems=None, seeds=(0, 1), **more):
    described = dict(describe([str(path) for path in paths], None, 0.01))
    systems = [system("pf"), system("ms")] if systems is None else systems
    return Plan(described, systems, seeds, ["vehicle-pf-tracker", "evaluate"], **more)


def here(cells):
    """Run cells in this process, one after the other."""
    for cell in cells:
        yield Turn(None, (cell,))
        yield Turn((cell, run_cell(cell)), ())


def silent(progress):
    pass


def results(folder):
    """Everything in an evaluation's folder that the input decides, by path."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.name == "estimates.csv":
            rows = list(csv.DictReader(path.open()))
            found[name] = [{k: v for k, v in row.items() if k != "step_ms"} for row in rows]
        elif path.suffix == ".json" and path.name != "digests.json":
            document = json.loads(path.read_text())
            left = {k: v for k, v in document.items() if k not in NOT_DECIDED_BY_THE_INPUT}
            found[name] = left
        elif path.is_file() and path.name != "digests.json":
            found[name] = path.read_bytes()
    return found
