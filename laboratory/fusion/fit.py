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
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from laboratory.fusion.case_lists import judged_cases, listed_cases
from laboratory.fusion.objective import camera_means
from laboratory.fusion.options import NUMBERS, make_parser, parsed, report_progress
from laboratory.fusion.score_table import score_table
from laboratory.fusion.settings import Setting, draw_settings, fitted
from laboratory.stress import Result, StressSystem, run_battery, variant_system
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.errors import InputError

FITTED_KINDS = ("plain", "wall", "lorry", "shifted_box", "later_start", "half_rate")
"""Kinds that are hard for it; mirrored or darker images behave as the plain ones."""
FITTED_FRAMES = 90
"""Frames of a case at most: an occlusion with its ends, or three seconds of driving."""


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
    for cases, seeds in judged_cases(options):
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


def _system(label: str, setting: Setting) -> StressSystem:
    return variant_system("fusion", dict(setting), label)


def main() -> int:
    """Fit, judge, write both."""
    options = parsed(make_parser(__doc__, *NUMBERS))
    text = score_table(judge(options, fit(options)))
    (options.output / "leave_one_camera_out.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.fit"))
