# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""No compiled kernel reads or writes outside its arrays, whatever it is given.

It runs in a process of its own, which memory that is overwritten would end.
"""

import os
import subprocess
import sys

import pytest

PROGRAM = """
import collections
import cv2, numpy as np
from vehicle_pf_tracker.image.windows.colour import JointColour, RgbMarginals
from vehicle_pf_tracker.image.windows.gradients import GradientDirections
from vehicle_pf_tracker.image.kernels import (
    numba_box_colours,
    numba_box_motion,
    numba_cells,
    numba_counts,
    numba_map_search,
    numba_pixel_cells,
    numba_windows,
)
from vehicle_pf_tracker.image.kernels.interface import load_kernels
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.textures import Cooccurrence
from vehicle_pf_tracker.image.windows.window import Window

rng = np.random.default_rng(0)
kernels = load_kernels("numba")
outcomes = collections.Counter()


def attempt(work, *arguments):
    try:
        result = work(*arguments)
    except (IndexError, ValueError, cv2.error):
        outcomes["refused"] += 1
        return None
    outcomes["done"] += 1
    return result


def maybe_broken(positions):
    if len(positions) and rng.random() < 0.2:
        odd = [np.nan, np.inf, -np.inf, 1e300, -1e300, 2.0**63]
        positions[rng.integers(len(positions))] = rng.choice(odd)
    return positions


for _ in range(1500):
    height, width = rng.integers(1, 60, 2)
    frame = rng.integers(0, 256, (height, width, 3), dtype=np.uint8)
    positions = maybe_broken(rng.normal(30, 30, (int(rng.choice([0, 1, 5, 200])), 2)))
    window = Window(*rng.integers(0, 40, 2).tolist())
    bits = int(rng.integers(1, 6))
    feature = [
        JointColour(bits), RgbMarginals(), Cooccurrence(),
        GradientDirections(0.3, True, bool(rng.integers(2)), 40.0),
    ][rng.integers(4)]
    other = rng.choice([0, 1, 7, 8, 63, 64, 512, 4096])
    length = int(rng.choice([feature.bins, other]))
    reference = Reference(rng.random(length) * (rng.random() < 0.9))
    rho = attempt(kernels.similarity, feature, frame, positions, window, reference)
    if rho is not None:
        assert length >= feature.bins and rho.shape == (len(positions),)
    used = int(rng.choice([bits, rng.integers(0, 10)]))
    for work in (kernels.kernel_similarity, kernels.mean_shift):
        attempt(work, frame, positions, window, reference, used)
    # The compiled functions themselves, with arrays that do not belong together.
    cells = rng.integers(0, int(rng.choice([2, 16, 70])), (1, height, width)).astype(np.uint16)
    values = rng.random(16)
    scale = values, np.sqrt(np.arange(5000.0))
    pixels = rng.integers(-2, 70, (5, 2))
    reach = tuple(rng.integers(-1, 30, 3).tolist())
    attempt(numba_windows.compare_windows, cells, pixels, reach, scale)
    counts = rng.integers(-1, 50, (3, 16)).astype(np.int32)
    attempt(numba_counts.compare_counts, counts, rng.integers(0, 90, 3), scale)
    table = rng.integers(0, 99, int(rng.choice([0, 5, 64, 512]))).astype(np.uint16)
    attempt(numba_pixel_cells.joint_cells, frame, int(rng.integers(-1, 10)), table)
    attempt(numba_pixel_cells.joint_shares, frame, int(rng.integers(-1, 7)))
    attempt(numba_pixel_cells.marginal_cells, frame, int(rng.integers(-1, 300)), table)
    attempt(numba_pixel_cells.pair_cells, frame[..., 0], table)
    grey = np.ascontiguousarray(frame[..., 0])
    attempt(numba_cells.gradient_cells, grey, int(rng.integers(-40, 2)))
    places = rng.integers(-1, 30, (int(rng.integers(9)), int(rng.choice([2, 2, 2, 3]))))
    costs = rng.random((int(rng.integers(1, 9)), int(rng.integers(1, 9))))
    attempt(numba_map_search.climbed, rng.random((height, width)), places, costs)
    costs = rng.random((2 * int(rng.integers(40)) + 1,) * 2)
    attempt(numba_map_search.climbed, rng.random((height, width)), places % width, costs)
    boxes, covers = (rng.integers(-90, 150, (int(rng.integers(4)), 4)) for _ in range(2))
    ends = np.sort(rng.integers(-1, 5, int(rng.integers(4))))
    attempt(numba_box_colours.count_colours, frame, boxes, covers, ends)
    flow = rng.normal(size=(height, width, 2)).astype(np.float32)
    block = rng.integers(-1, 15, (2, 2))
    maps = [rng.normal(size=(int(rng.choice([2, 2, 2, 0, 3])), 2)) for _ in range(3)]
    attempt(numba_box_motion.carried_share, flow, block, *maps)
    alive = rng.random(int(rng.integers(9))) < 0.5
    ends = [rng.random((int(rng.choice([len(alive), 7])), 2)) for _ in range(2)]
    attempt(numba_box_motion.staying, *ends, alive, 0.2)
assert outcomes["refused"] > 2000 < outcomes["done"], outcomes
print("done")
"""


@pytest.mark.slow
def test_arguments_that_do_not_fit_are_refused():
    pytest.importorskip("numba", reason="numba is not installed")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr[-2000:]
