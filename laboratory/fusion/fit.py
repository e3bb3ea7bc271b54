# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit the numbers of `fusion` to recordings with truth, and judge them on cameras left out.

``python -m laboratory.fusion.fit SEQUENCES -o results/fusion_fit`` draws `--budget` settings of the
parameters that are marked as tuned, around the present defaults, and runs each over the same cases
of every camera. The fitted setting is the mean of the best quarter (one step of the cross-entropy
method): once by all cameras, and for each camera by all others. ``fit.json`` has all of them;
``leave_one_camera_out.md`` has what the latter reach on the camera that they have not seen.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import pickle
import statistics
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from laboratory.stress import (
    Case,
    Result,
    Score,
    StressSystem,
    find_sequences,
    list_cases,
    run_battery,
    variant_system,
)
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import ParameterSpec, specs
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters

FITTED_KINDS = ("plain", "wall", "lorry", "shifted_box", "later_start", "half_rate")
"""Kinds that are hard for it; mirrored or darker images behave as the plain ones."""
FITTED_FRAMES = 90
"""Frames of a case at most: an occlusion with its ends, or three seconds of driving."""
SPREAD = 0.25
"""Standard deviation of the draws, of the logarithm of a parameter: a factor of 1.3."""
ELITE = 4
"""One setting in so many counts as good; their mean varies less than the best one."""
# Kinds that a fit is judged by on the camera left out; the first is listed whole.
JUDGED_KINDS = ("plain", "shifted_box", "wall", "lorry")

Setting = Mapping[str, float]


def tuned_parameters() -> dict[str, ParameterSpec]:
    """Every number of `fusion` that is fitted, with its range."""
    table = specs(FusionParameters)
    return {name: spec for name, spec in table.items() if isinstance(spec.tuned, tuple)}


def draw_settings(budget: int, seed: int) -> list[Setting]:
    """Draw settings around the defaults, which are the first."""
    rng = np.random.default_rng(seed)
    table = tuned_parameters()
    # The defaults take part as one of the settings.
    settings: list[Setting] = [{name: float(spec.default) for name, spec in table.items()}]
    for _ in range(budget - 1):
        # Factors: parameters are rates and scales, of which half and double are equally far.
        factors = np.exp(SPREAD * rng.normal(size=len(table)))
        drawn = {}
        for (name, spec), factor in zip(table.items(), factors, strict=True):
            assert isinstance(spec.tuned, tuple)
            # The table's range holds for the fit, too.
            drawn[name] = float(np.clip(float(spec.default) * factor, *spec.tuned))
        settings.append(drawn)
    return settings


def objective(score: Score) -> float:
    """On target plus overlap plus occlusions recovered, less frames of a wrong mode; all shares.

    Without the mode, settings that doubt a tenth of the visible frames are as good as any.
    """
    value = (score.on_target or 0.0) + (score.mean_iou or 0.0)
    value -= (score.doubted or 0.0) + (score.claimed_hidden or 0.0)
    # Without a judged occlusion the share is full: cases without one differ by the rest alone.
    return value + (score.recovered / score.judged if score.judged else 1.0)


def fitted(
    settings: Sequence[Setting], by_camera: Sequence[Mapping[str, float]], without: str = ""
) -> Setting:
    """Average the best quarter of the settings, geometrically, by all cameras but one."""
    means = [
        statistics.fmean(value for camera, value in scores.items() if camera != without)
        for scores in by_camera
    ]
    order = sorted(range(len(settings)), key=lambda index: -means[index])
    # One setting at least, also of a small budget.
    best = [settings[index] for index in order[: max(len(settings) // ELITE, 1)]]
    return {name: _geometric_mean([one[name] for one in best]) for name in settings[0]}


def _geometric_mean(values: Sequence[float]) -> float:
    # A 0 has no logarithm.
    if min(values) <= 0:
        return statistics.fmean(values)
    return float(f"{math.exp(statistics.fmean(map(math.log, values))):.3g}")


def camera_means(results: Sequence[Result]) -> dict[str, float]:
    """Mean objective of each camera, over kinds of cases and then over these."""
    cameras = dict.fromkeys(result.case.camera for result in results)
    means = {}
    for camera in cameras:
        own = [result for result in results if result.case.camera == camera]
        kinds = dict.fromkeys(result.case.kind for result in own)
        # Kinds weigh alike, however many cases of each a sequence gives.
        means[camera] = statistics.fmean(
            statistics.fmean(objective(r.score) for r in own if r.case.kind == kind)
            for kind in kinds
        )
    return means


def _system(label: str, setting: Setting) -> StressSystem:
    return variant_system("fusion", dict(setting), label)


def listed_cases(
    options: argparse.Namespace, name: str, kinds: Sequence[str], **limits: int
) -> list[Case]:
    """List cases, or read those that a run before listed by the same options: it takes a minute."""
    # Recordings that were added to a folder since do not show; they need another output.
    selection = (
        [str(folder.resolve()) for folder in options.sequences],
        options.cameras.read_text(encoding="utf-8"),
        tuple(kinds),
        options.seed,
        sorted(limits.items()),
    )
    digest = hashlib.sha256(repr(selection).encode()).hexdigest()[:8]
    path = options.output / f"{name}_{digest}.pickle"
    if not path.exists():
        sources = find_sequences(options.sequences, options.cameras)
        cases = list_cases(sources, kinds=kinds, seed=options.seed, **limits)
        path.write_bytes(pickle.dumps(cases))
    cases = pickle.loads(path.read_bytes())  # noqa: S301 - written by the run before
    return list(cases)


def fit(options: argparse.Namespace) -> dict[str, Setting]:
    """Fit by all cameras (key "") and by all but each.

    Raises
    ------
    InputError
        If there is one camera alone: without it nothing is left to fit by.
    """
    cases = listed_cases(
        options, "fit_cases", FITTED_KINDS, per_sequence=options.cases, max_frames=FITTED_FRAMES
    )
    cameras = {case.camera for case in cases}
    if len(cameras) < 2:
        raise InputError(
            f"all sequences are of the camera {', '.join(cameras)}: a setting is judged on a "
            "camera that it was not fitted by, which takes two cameras or more"
        )
    settings = draw_settings(options.budget, options.seed)
    systems = [_system(f"{index}", setting) for index, setting in enumerate(settings)]
    results = run_battery(
        cases, systems, seeds=(0,), workers=options.workers,
        store=options.output / "fit.jsonl", on_progress=report_progress,
    )  # fmt: skip
    by_camera = [
        camera_means([result for result in results if result.system == system.label])
        for system in systems
    ]
    # The key "" is no camera: the fit by all of them.
    chosen = {"": fitted(settings, by_camera)}
    for camera in by_camera[0]:
        chosen[camera] = fitted(settings, by_camera, camera)
    _write_fit(options.output / "fit.json", chosen, settings, by_camera)
    return chosen


def _write_fit(
    path: Path,
    chosen: Mapping[str, Setting],
    settings: Sequence[Setting],
    by_camera: Sequence[Mapping[str, float]],
) -> None:
    drawn = [
        {"setting": setting, "objective": scores}
        for setting, scores in zip(settings, by_camera, strict=True)
    ]
    document = {"all": chosen[""], "without": {k: v for k, v in chosen.items() if k}}
    path.write_text(json.dumps({**document, "drawn": drawn}, indent=1), encoding="utf-8")


def judge(options: argparse.Namespace, chosen: Mapping[str, Setting]) -> list[Result]:
    """Run the settings that were fitted without a camera on that camera."""
    results: list[Result] = []
    plain = listed_cases(options, "plain_cases", ("plain",))
    # The plain kind is listed whole, the hard ones a few of each sequence.
    hard = listed_cases(options, "judged_cases", JUDGED_KINDS[1:], per_sequence=options.hard)
    for cases, seeds in ((plain, range(options.seeds)), (hard, range(1))):
        for camera, setting in chosen.items():
            # Each camera by the setting that was fitted without it.
            own = [case for case in cases if camera and case.camera == camera]
            if own:
                results += run_battery(
                    own,
                    [_system("fusion", setting)],
                    seeds=tuple(seeds),
                    workers=options.workers,
                    store=options.output / "judged.jsonl",
                    on_progress=report_progress,
                )
    return results


def _row(name: str, results: Sequence[Result]) -> str:
    scores = [result.score for result in results]

    def mean(values: Sequence[float | None]) -> str:
        known = [value for value in values if value is not None]
        return f"{statistics.fmean(known):.3f}" if known else "–"

    recovered = sum(s.recovered for s in scores)
    judged = sum(s.judged for s in scores)
    cells = [
        name, f"{len(scores)}", mean([s.on_target for s in scores]),
        mean([s.mean_iou for s in scores]), f"{sum(bool(s.lost) for s in scores)}",
        f"{recovered} of {judged}" if judged else "–",
        mean([s.rmse_visible_px for s in scores]), mean([s.doubted for s in scores]),
        mean([s.claimed_hidden for s in scores]),
        f"{max(s.longest_false_tracking for s in scores)}",
        mean([s.reliability_visible.calibration_error for s in scores]),
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def page(results: Sequence[Result]) -> str:
    """Tables of what was reached on cameras left out."""
    head = (
        "| | runs | on target | IoU | runs below .9 | recovered | RMSE visible, px | doubted | "
        "claimed hidden | longest false run | ECE |\n|---|" + "---:|" * 10
    )
    plain = [result for result in results if result.case.kind == "plain"]
    sequences = dict.fromkeys(result.case.sequence for result in plain)
    rows = [
        _row(name, [result for result in plain if result.case.sequence == name])
        for name in sequences
    ]
    rows.append(_row("**all sequences**", plain))
    for kind in JUDGED_KINDS[1:]:
        own = [result for result in results if result.case.kind == kind]
        for path in dict.fromkeys(result.case.label("path") for result in own):
            part = [result for result in own if result.case.label("path") == path]
            rows.append(_row(" ".join(filter(None, (kind, path))), part))
    return "\n".join([head, *rows]) + "\n"


def report_progress(done: int, total: int | None) -> None:
    """Tell how many runs are done, now and then."""
    if done % 50 == 0 or done == total:
        print(f"{done} of {total} runs", file=sys.stderr, flush=True)


NUMBERS = {
    "budget": (48, "settings that are tried"),
    "cases": (3, "cases of each sequence to fit to"),
    "seeds": (5, "seeds of the plain sequences"),
    "hard": (6, "hard cases of each sequence to judge"),
}
"""Options of the programs that fit or judge: default and help."""


def make_parser(purpose: str | None, *numbers: str) -> argparse.ArgumentParser:
    """Make the parser of a program over sequences with some of `NUMBERS` as options."""
    parser = argparse.ArgumentParser(description=(purpose or "").partition("\n")[0])
    parser.add_argument(
        "sequences", type=Path, nargs="+", help="folders of recordings or frame folders"
    )
    parser.add_argument("--cameras", type=Path, default=Path("benchmarks/cameras.csv"))
    for name in numbers:
        default, text = NUMBERS[name]
        parser.add_argument(f"--{name}", type=int, default=default, help=text)
    parser.add_argument("--seed", type=int, default=0, help="seed of all that is drawn")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("-o", "--output", type=Path, required=True)
    return parser


def parsed(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Read the command line, and make the folder of the results."""
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    return options


def main() -> int:
    """Fit, judge, write both."""
    options = parsed(make_parser(__doc__, *NUMBERS))
    text = page(judge(options, fit(options)))
    (options.output / "leave_one_camera_out.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.fit"))
