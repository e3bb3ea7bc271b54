# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The allocator's options, in a process of their own."""

from __future__ import annotations

import os
import platform
import subprocess
import sys

import pytest

COUNT_FAULTS = """
import resource, numpy as np
from vehicle_pf_tracker.ros.image_memory import keep_image_memory
done = keep_image_memory()
def faults():
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt
def show():
    for _ in range(100):
        [np.ones(640 * 480 * 3, np.uint8) for _ in range(3)]
show()
before = faults()
show()
print(int(done), faults() - before)
"""

pytestmark = pytest.mark.skipif(
    platform.libc_ver()[0] != "glibc", reason="the options are those of glibc"
)


def run(**environment: str) -> tuple[bool, int]:
    plain = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}
    told = subprocess.run(
        [sys.executable, "-c", COUNT_FAULTS],
        env={**plain, **environment},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    return bool(int(told[0])), int(told[1])


def test_images_find_their_memory_again():
    done, faults = run()
    assert done
    assert faults < 1000  # of 67500 pages


def test_what_the_environment_says_is_left_alone():
    done, faults = run(MALLOC_TOP_PAD_="65536")
    assert not done
    assert faults > 10_000
