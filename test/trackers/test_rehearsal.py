# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A rehearsal loads the kernels that a variant needs, and changes nothing else."""

import subprocess
import sys

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.rehearsal import rehearse

PROGRAM = """
import sys
from vehicle_pf_tracker.image.kernels.toolchain.kernel import kernels_of
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.rehearsal import rehearse
variant = VARIANTS[sys.argv[1]]
rehearse(variant, variant.parameters())
modules = [module for name, module in sys.modules.items() if ".kernels.numba_" in name]
kernels = {kernel for module in modules for kernel in kernels_of(module) if kernel.is_ready}
print(*sorted(kernel.__name__ for kernel in kernels))
"""


@pytest.mark.parametrize(
    ("variant", "needed"),
    [
        ("apf", {"number_cells", "joint_shares", "compare_joint"}),
        (
            "ms",
            {
                "number_cells",
                "joint_cells",
                "place_windows",
                "compare_kernels",
                "shift_kernels",
            },
        ),
        (
            "sfpf_edge",
            {"number_cells", "place_windows", "gradients", "count_edges", "compare_counts"},
        ),
    ],
)
def test_a_rehearsal_loads_what_the_step_needs_and_nothing_else(variant, needed):
    pytest.importorskip("numba", reason="there is nothing to compile")
    words = [sys.executable, "-c", PROGRAM, variant]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == needed


@pytest.mark.parametrize("name", VARIANTS)
def test_estimates_after_a_rehearsal_are_those_without(name):
    variant = VARIANTS[name]
    parameters = variant.parameters(seed=3, kernels="opencv")
    frames = np.random.default_rng(5).integers(0, 256, (3, 90, 120, 3), np.uint8)

    def positions():
        tracker = variant.tracker(parameters)
        tracker.start(frames[0], Box(40.0, 30.0, 30.0, 24.0))
        return [tracker.step(frame).position for frame in frames[1:]]

    before = positions()
    rehearse(variant, parameters)
    assert positions() == before


def test_a_rehearsal_draws_no_seed_of_its_own_from_the_parameters():
    variant = VARIANTS["pf"]
    parameters = variant.parameters(seed=-1, kernels="opencv")
    rehearse(variant, parameters)
    assert parameters.seed == -1
