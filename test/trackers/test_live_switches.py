# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every switch of every variant, on and off while it tracks, in a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from street import Street, error, follow

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.registry import VARIANTS

PROGRAM = Path(__file__).parent / "live_switches.py"
QUICK = ("apf", "adaptive", "mfpf")
"""One variant of each paper; all together take a minute of a processor."""
FEWEST_AND_MOST = ("1", "5")
"""Numbers of bits between which arrays differ most in size."""


@pytest.mark.parametrize(
    ("name", "bits"),
    [
        *((name, FEWEST_AND_MOST) for name in QUICK),
        *(pytest.param(name, "12345", marks=pytest.mark.slow) for name in VARIANTS),
    ],
)
def test_a_switch_that_is_turned_while_tracking(name, bits):
    search = os.pathsep.join([str(PROGRAM.parent), *sys.path])
    done = subprocess.run(
        [sys.executable, str(PROGRAM), name, *bits],
        env={**os.environ, "PYTHONPATH": search},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    word, count = done.stdout.split()[-2:]
    assert (word, int(count) > 0) == ("done", True)


@pytest.mark.parametrize("name", ["mfpf", "sfpf_color", "sfpf_texture", "conventional", "adaptive"])
@pytest.mark.parametrize("turned_on", [True, False])
def test_the_track_is_kept_over_a_switch_to_the_printed_algorithm(name, turned_on):
    variant, street = VARIANTS[name], Street(speed=1.0)
    tracker = variant.tracker(from_mapping(variant.parameters, {"as_printed": not turned_on}))
    follow(tracker, street, range(20))
    tracker.reconfigure(from_mapping(variant.parameters, {"as_printed": turned_on}))
    estimates = [tracker.step(street.frame(time)) for time in range(20, 45)]
    late = range(30, 45)
    errors = [error(estimates[time - 20], street, time) for time in late]
    assert np.median(errors) < 6
    assert {estimates[time - 20].mode for time in late} == {Mode.TRACKING}
    assert any(estimates[time - 20].regime != "prediction" for time in late)
