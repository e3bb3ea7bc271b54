# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parameter `kernels`, which every variant has."""

import importlib
import subprocess
import sys

import pytest
from street import Street, follow

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels import interface
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS


@pytest.fixture
def numba_fails(monkeypatch):
    """Make the import of numba fail with an error of one's choice."""

    def fail_with(error):
        def import_module(name):
            raise error

        monkeypatch.setattr(importlib, "import_module", import_module)

    interface.load_numba.cache_clear()
    yield fail_with
    interface.load_numba.cache_clear()


ABSENT = ModuleNotFoundError("No module named 'numba'", name="numba")
BROKEN = ImportError("Numba needs NumPy 2.2 or less")
TORN = OSError("Could not find/load shared object file 'libllvmlite.so'")


def make(name, **values):
    variant = VARIANTS[name]
    return variant.tracker(from_mapping(variant.parameters, values))


def test_auto_takes_numba_where_it_is():
    pytest.importorskip("numba", reason="numba is not installed")
    assert make("pf").kernels.name == "numba"
    assert make("pf", kernels="numba").kernels.name == "numba"


def test_auto_takes_opencv_where_numba_is_not_installed(numba_fails):
    numba_fails(ABSENT)
    kernels = make("pf").kernels
    assert kernels.name == "opencv"
    assert list(kernels.notices) == []


@pytest.mark.parametrize("error", [BROKEN, TORN], ids=["broken", "torn"])
def test_auto_tells_why_an_installed_numba_does_not_serve(numba_fails, error):
    numba_fails(error)
    kernels = make("pf").kernels
    assert kernels.name == "opencv"
    assert len(kernels.notices) == 1
    assert str(error) in kernels.notices[0]


@pytest.mark.parametrize("error", [ABSENT, BROKEN, TORN], ids=["absent", "broken", "torn"])
def test_asking_for_numba_without_it_is_a_clear_error(numba_fails, error):
    numba_fails(error)
    with pytest.raises(InputError, match=r"kernels: numba .* cannot be imported .*; install it"):
        from_mapping(VARIANTS["pf"].parameters, {"kernels": "numba"})


def test_opencv_leaves_numba_alone():
    program = (
        "import sys\n"
        "from vehicle_pf_tracker.trackers.registry import VARIANTS\n"
        "for variant in VARIANTS.values():\n"
        "    variant.tracker(variant.parameters(kernels='opencv'))\n"
        "print('numba' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


LAST_DIGITS = {"fusion": 0.02}
"""px. OpenCV samples a patch at steps of 1/32 px: where rounding takes a place from one step to the
next, the response to a size changes by a thousandth, and the box by so much."""


@pytest.mark.parametrize("name", VARIANTS)
def test_kernels_change_the_last_digits_at_most(name):
    pytest.importorskip("numba", reason="numba is not installed")
    street, times = Street(hidden=(9, 12)), range(5)
    ours = follow(make(name, kernels="numba"), street, times)
    theirs = follow(make(name, kernels="opencv"), street, times)
    for one, other in zip(ours, theirs, strict=True):
        assert one.position == pytest.approx(other.position, abs=LAST_DIGITS.get(name, 1e-3))
        assert one.confidence == pytest.approx(other.confidence, abs=1e-3)
