# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates do not depend on the number of threads, which BLAS and OpenCV take from the machine."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from vehicle_pf_tracker.trackers.registry import VARIANTS

DIGESTS = """
import hashlib, json, sys
import cv2, numpy as np
cv2.setNumThreads(int(sys.argv[1]))
from street import Street, follow
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS
street = Street(hidden=(14, 22))
found = {}
for name, variant in VARIANTS.items():
    tracker = variant.tracker(from_mapping(variant.parameters, {"seed": 3}))
    digest = hashlib.sha256()
    for estimate in follow(tracker, street, range(30)):
        digest.update(estimate.particles.tobytes() + estimate.weights.tobytes())
        digest.update(np.array([*estimate.position, *estimate.velocity]).tobytes())
    found[name] = digest.hexdigest()
print(json.dumps(found))
"""


def digests(threads):
    counts = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), str(threads))
    search = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    command = [sys.executable, "-c", DIGESTS, str(threads)]
    environment = {**os.environ, **counts, "PYTHONPATH": search}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="BLAS takes one thread on one core")
def test_estimates_are_the_same_with_one_thread_and_with_two():
    one, two = digests(1), digests(2)
    assert set(one) == set(VARIANTS)
    assert one == two
