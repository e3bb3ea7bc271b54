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

"""A small evaluation folder: two recordings, three variants and a baseline that could not run."""

import json

from drive import HEIGHT, WIDTH, box_of, frame_of, stamp_of

from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import cell_folder, write_truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.offline.driver import OfflineTracker
from vehicle_pf_tracker.offline.output_files import make_folder, write_json
from vehicle_pf_tracker.offline.run_folder import RunFolder, RunInfo, describe_run, seal, versions
from vehicle_pf_tracker.parameters.table import from_mapping, to_mapping
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.trackers.registry import find_variant

FRAMES = 36
HIDDEN = {"under_a_bridge": range(8, 14), "free": range(0)}
VARIANTS = ("pf", "ms", "apf")
SEEDS = (0, 1)
ALONE = {"ms": SEEDS[:1]}
"""Seeds of those that draw nothing."""
NO_BASELINES = "the environment of the baselines is not there; make it with `make baselines`"


def make_evaluation(folder):
    """Make the folder's `evaluation`, and the recordings beside it; returns the former."""
    made = folder / "evaluation"
    truths = {name: _record(folder / name, hidden) for name, hidden in HIDDEN.items()}
    for name, truth in truths.items():
        make_folder(made / "recordings" / name)
        write_truth(made / "recordings" / name / "truth.csv", dict(enumerate(truth, start=1)))
        for seed in SEEDS:
            for variant in VARIANTS:
                if seed in ALONE.get(variant, SEEDS):
                    _run(
                        cell_folder(made, name, variant, seed), folder / name, truth, variant, seed
                    )
            failed = make_folder(cell_folder(made, name, "baseline:csrt", seed)) / "failed.json"
            write_json(failed, {"reason": NO_BASELINES})
    write_json(made / "evaluation.json", _plan(folder))
    return made


def _frame(index, hidden):
    frame = frame_of(index)
    if index in hidden:
        frame[20:40] = 70
    return frame


def _record(path, hidden):
    truths = [
        Truth(stamp_of(i), box_of(i), Occlusion.TOTAL if i in hidden else Occlusion.NONE)
        for i in range(FRAMES)
    ]
    with RecordingWriter(path) as writer:
        for index, truth in enumerate(truths):
            writer.write_image(truth.stamp_ns, _frame(index, hidden))
            writer.write_truth(truth)
    return truths


def _parameters(variant, seed):
    values = {"seed": seed}
    if "num_particles" in to_mapping(variant.parameters()):
        values["num_particles"] = 40
    return from_mapping(variant.parameters, values)


def _run(folder, recording, truth, name, seed):
    variant = find_variant(name)
    tracker = OfflineTracker(variant, _parameters(variant, seed), first_truth=truth[0])
    hidden = HIDDEN[recording.name]
    rows = list(tracker.rows([(stamp_of(i), _frame(i, hidden)) for i in range(FRAMES)]))
    results = RunFolder(folder)
    info = RunInfo([], str(recording), "/camera/image_raw", tracker.start_frame, [])
    results.write_run(rows, describe_run(info, tracker.session))
    results.write_metrics(measure(score_frames(rows, truth)).to_json())
    seal(folder)


def _plan(folder):
    systems = [
        {
            "label": name, "variant": name, "parameter_set": "", "overrides": {"num_particles": 40},
            "parameters": to_mapping(_parameters(find_variant(name), 0)),
            "seeds": ALONE.get(name, SEEDS),
        }
        for name in VARIANTS
    ]  # fmt: skip
    systems.append(
        {"label": "baseline:csrt", "baseline": "csrt", "overrides": {}, "parameters": {}}
    )
    recordings = [
        {
            "name": name, "path": str(folder / name), "topic": "/camera/image_raw",
            "frames": FRAMES, "width": WIDTH, "height": HEIGHT, "digest": "0" * 64,
        }
        for name in HIDDEN
    ]  # fmt: skip
    plan = {
        "format": 2,
        "command": ["vehicle-pf-tracker", "evaluate", "free", "-o", "evaluation"],
        "recordings": recordings,
        "systems": systems,
        "seeds": SEEDS,
        "versions": versions(),
        "options": {"max_diff": 0.01},
    }
    return json.loads(json.dumps(plan))
