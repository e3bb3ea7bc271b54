# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Runs that docs/reproduction.md is made of give the same errors as they did.

`page_runs.jsonl` has the RMSE of runs with seed 0 by the two versions that made the page: of 22
November 2026 (`b0cdc041`) and of 26 November (`06093edb`).
"""

import importlib.util
import json
import platform
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np
import pytest

from reproduction.catalogue import EXPERIMENTS
from reproduction.experiment import Size
from reproduction.runs.cells import SceneChoice
from reproduction.runs.running import run_together

RUNS = [
    json.loads(line)
    for line in Path(__file__).with_name("page_runs.jsonl").read_text("utf-8").splitlines()
]
MADE_WITH = ("2.4", "5.0", "x86_64", True)
"""NumPy, OpenCV, processor and compiled kernels of the runs: others may move the last digits, and
these a choice."""


SAME = 1e-12
"""Relative difference within which processors agree on an error: where the runs were made, it is
repeated to the last bit, and on another processor errors were 5e-15 off."""


def scene_of(run):
    return SceneChoice.of(run["scene"], run["scene_settings"]).seeded(run["seed"])


BY_SCENE = [
    pytest.param(list(runs), id=f"{commit}-{experiment}-{number}")
    for number, ((commit, experiment, _), runs) in enumerate(
        groupby(RUNS, lambda run: (run["commit"], run["experiment"], scene_of(run)))
    )
]


@pytest.mark.slow
@pytest.mark.parametrize("runs", BY_SCENE)
def test_runs_of_the_page_are_repeated(runs):
    is_compiled = importlib.util.find_spec("numba") is not None
    if (np.__version__[:3], cv2.__version__[:3], platform.machine(), is_compiled) != MADE_WITH:
        pytest.skip(f"the page was made with {MADE_WITH}")
    # The experiment of today still has these very runs: its variants, settings and scenes.
    planned = {
        (cell.scene, cell.system.label, cell.system.settings): cell
        for cell in EXPERIMENTS[runs[0]["experiment"]].cells(Size(range(1)))
    }
    cells = []
    for run in runs:
        settings = tuple(sorted(run["settings"].items()))
        cells.append(planned[scene_of(run), run["system"], settings])
    found = [result["metrics"]["rmse_px"] for result in run_together(tuple(cells))]
    assert found == pytest.approx([run["rmse_px"] for run in runs], rel=SAME, abs=0)
