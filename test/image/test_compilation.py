# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Where compiled kernels are kept, and what happens where they cannot be."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import vehicle_pf_tracker

PROGRAM = """
from vehicle_pf_tracker.image.kernels import numba_jit
from vehicle_pf_tracker.image.kernels.twice import twice
print(twice(4), len(twice.stats.cache_hits), *numba_jit.notices())
"""
TWICE = """
from numba import types
from vehicle_pf_tracker.image.kernels.numba_jit import compiled

@compiled(types.int64(types.int64))
def twice(number):
    return 2 * number
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package with one more compiled module, into whose folder nothing is written."""
    pytest.importorskip("numba", reason="numba is not installed")
    package = tmp_path / "package" / "vehicle_pf_tracker"
    original = Path(vehicle_pf_tracker.__file__).parent
    no_cache = shutil.ignore_patterns("__pycache__")
    shutil.copytree(original / "image", package / "image", ignore=no_cache)
    shutil.copy(original / "__init__.py", package)
    (package / "image/kernels/twice.py").write_text(TWICE)
    # Permissions do not hold root back; that there is a file of this name does.
    (package / "image/kernels/__pycache__").touch()
    return package.parent


def run(copy, cache, **variables):
    environment = {**os.environ, "PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(cache), **variables}
    if not variables:
        environment.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run(
        [sys.executable, "-B", "-c", PROGRAM],
        env=environment,
        cwd=copy,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_a_read_only_install_keeps_them_in_the_users_cache(copy, tmp_path):
    assert run(copy, tmp_path / "cache") == "8 0"
    assert list((tmp_path / "cache").rglob("twice.twice-*.nbi"))
    assert run(copy, tmp_path / "cache") == "8 1"


def test_without_any_place_each_start_compiles_and_says_so(copy, tmp_path):
    (tmp_path / "cache").touch()
    told = run(copy, tmp_path / "cache")
    assert told.startswith("8 0 compiled kernels cannot be kept on disk (")
    assert "NUMBA_CACHE_DIR" in told


def test_the_folder_of_ones_choice_is_used(copy, tmp_path):
    (tmp_path / "cache").touch()
    folder = tmp_path / "mine"
    assert run(copy, tmp_path / "cache", NUMBA_CACHE_DIR=str(folder)) == "8 0"
    (index,) = folder.rglob("twice.twice-*.nbi")
    index.write_bytes(b"torn")
    told = run(copy, tmp_path / "cache", NUMBA_CACHE_DIR=str(folder))
    assert told.startswith("8 0 compiled kernels cannot be kept on disk (")
