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

"""Fit the numbers of `traffic` to synthetic scenes, and judge them on real ones.

    python -m laboratory.traffic_fit CLIP... -o results/traffic_fit

Renders scenes with seeds that are used nowhere else, draws `--budget` settings of `TrafficNumbers`
around the shipped ones, and follows all vehicles of these scenes with each, from two simulated
detectors and from motion. The fitted setting is the mean of the best quarter (one step of the
cross-entropy method). It and the shipped one are then run on the real clips, which had no part in
the fit, several times each (`traffic_spread`). ``fit.json`` has all settings and scores.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.traffic_spread import HEAD, judged, shortened, summary
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.traffic.comparison import MOTION
from vehicle_pf_tracker.evaluation.traffic.scoring import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.trackers.traffic.detections import SHIPPED, TrafficNumbers

TRAINING = {
    "traffic-lanes": 101,
    "traffic-queue": 102,
    "traffic-lorries": 103,
    "traffic-bridge": 104,
}
"""Scenes and their seeds."""
SOURCES = ("poor", MOTION)
"""A detector that errs, and the embedded one; a good one is followed well by any setting."""
SPREAD = 0.25
"""Standard deviation of the draws, of the logarithm of a number: a factor of 1.3."""
ELITE = 4
"""One setting in so many counts as good; their mean varies less than the best one."""

Setting = Mapping[str, float]


def draw_settings(budget: int, seed: int) -> list[Setting]:
    """Draw settings around the shipped one, which is the first."""
    rng = np.random.default_rng(seed)
    shipped: Setting = asdict(SHIPPED)
    return [shipped] + [
        {name: value * math.exp(SPREAD * rng.normal()) for name, value in shipped.items()}
        for _ in range(budget - 1)
    ]


def fitted(settings: Sequence[Setting], values: Sequence[float]) -> Setting:
    """Average the best quarter of the settings, geometrically."""
    order = sorted(range(len(settings)), key=lambda index: -values[index])
    best = [settings[index] for index in order[: max(len(settings) // ELITE, 1)]]
    return {
        name: float(f"{math.exp(statistics.fmean(math.log(one[name]) for one in best)):.3g}")
        for name in settings[0]
    }


def training_scenes(folder: Path, frames: int) -> list[TrafficSequence]:
    """Render the scenes to fit to, unless they are there."""
    for name, seed in TRAINING.items():
        if not (folder / name).is_dir():
            scene = make_traffic_scene(name, seed=seed, settings={"frames": frames})
            write_mot_folder(scene, folder / name, seed=seed)
    return [read_sequence(folder / name) for name in TRAINING]


def objectives(
    worker: TrafficWorker, setting: Setting, scenes: Sequence[TrafficSequence]
) -> dict[str, float]:
    """Mean of HOTA and IDF1 in each scene, from each source."""
    numbers = TrafficNumbers(**setting)
    values = {}
    for scene in scenes:
        for source in SOURCES:
            run = judged(worker, scene, source, 0, numbers)
            values[f"{scene.name} {source}"] = (run.hota + run.idf1) / 2
    return values


def fit(options: argparse.Namespace, worker: TrafficWorker) -> Setting:
    """Fit to the training scenes; all that was tried is written."""
    scenes = training_scenes(options.output / "scenes", options.frames)
    settings = draw_settings(options.budget, options.seed)
    scores: list[dict[str, float]] = []
    for number, setting in enumerate(settings, start=1):
        scores.append(objectives(worker, setting, scenes))
        mean = statistics.fmean(scores[-1].values())
        print(f"{number} of {len(settings)} settings: {mean:.1f}", file=sys.stderr, flush=True)
    chosen = fitted(settings, [statistics.fmean(one.values()) for one in scores])
    own = objectives(worker, chosen, scenes)
    drawn = [
        {"setting": setting, "scores": one} for setting, one in zip(settings, scores, strict=True)
    ]
    document = {"fitted": {"setting": chosen, "scores": own}, "drawn": drawn}
    (options.output / "fit.json").write_text(json.dumps(document, indent=1), encoding="utf-8")
    trained, before = (statistics.fmean(one.values()) for one in (own, scores[0]))
    print(f"training scenes: fitted {trained:.1f}, shipped {before:.1f}", file=sys.stderr)
    return chosen


def judge(options: argparse.Namespace, worker: TrafficWorker, chosen: Setting) -> None:
    """Print what both settings reach on the clips."""
    print(HEAD)
    for folder in options.clips:
        scene = read_sequence(folder)
        scene = shortened(scene, 1, min(options.judged, scene.frame_count))
        for source in (*scene.detections, MOTION):
            if options.detections and source not in options.detections.split(","):
                continue
            for label, setting in (("fitted", chosen), ("shipped", asdict(SHIPPED))):
                numbers = TrafficNumbers(**setting)
                runs = [
                    judged(worker, scene, source, number, numbers) for number in range(options.runs)
                ]
                print(f"| {scene.name}, {source}, {label} | {summary(runs)} |", flush=True)


def main() -> int:
    """Fit, judge, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("clips", nargs="+", type=Path, help="real scenes with truth to judge on")
    parser.add_argument("--budget", type=int, default=16, help="settings that are tried")
    parser.add_argument("--frames", type=int, default=240, help="frames of a training scene")
    parser.add_argument("--judged", type=int, default=10**6, help="frames of a clip at most")
    parser.add_argument("--runs", type=int, default=4, help="runs of a clip")
    parser.add_argument("--detections", help="sources to judge, separated by commas; all")
    parser.add_argument("--seed", type=int, default=0, help="seed of the draws")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    try:
        with TrafficWorker() as worker:
            judge(options, worker, fit(options, worker))
    except InputError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
