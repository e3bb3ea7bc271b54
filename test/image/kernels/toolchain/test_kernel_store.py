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
from vehicle_pf_tracker.image.kernels.toolchain.object_code import ObjectCode

kernel_store = pytest.importorskip(
    "vehicle_pf_tracker.image.kernels.toolchain.kernel_store", reason="numba is not installed"
)

PROGRAM = """
import sys
from vehicle_pf_tracker.image.kernels.toolchain import kernel
from vehicle_pf_tracker.image.kernels.numba_twice import twice
print(twice(4), "compiled" if "numba" in sys.modules else "linked", *kernel.notices())
"""
TWICE = """
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined

FACTOR = 2

@inlined
def times(number):
    return FACTOR * number

@compiled("int64", "int64")
def twice(number):
    return times(number)
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package with one more compiled module, into whose folder nothing is written."""
    package = tmp_path / "package" / "vehicle_pf_tracker"
    original = Path(vehicle_pf_tracker.__file__).parent
    no_cache = shutil.ignore_patterns("__pycache__")
    shutil.copytree(original / "image", package / "image", ignore=no_cache)
    shutil.copy(original / "__init__.py", package)
    (package / "image/kernels/numba_twice.py").write_text(TWICE)
    # Permissions do not hold root back; that there is a file of this name does.
    (package / "image/kernels/__pycache__").touch()
    return package.parent


def run(copy, cache, **variables):
    environment = {**os.environ, "PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(cache), **variables}
    if "NUMBA_CACHE_DIR" not in variables:
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


def kept(folder):
    return list(folder.rglob("numba_twice.twice.*.kernel"))


def test_a_read_only_install_keeps_them_in_the_users_cache(copy, tmp_path):
    assert run(copy, tmp_path / "cache") == "8 compiled"
    (file,) = kept(tmp_path / "cache")
    assert run(copy, tmp_path / "cache") == "8 linked"
    # Torn, as a full disk leaves it: made anew.
    file.write_bytes(file.read_bytes()[:-1])
    assert run(copy, tmp_path / "cache") == "8 compiled"
    assert run(copy, tmp_path / "cache") == "8 linked"
    # Python itself, for those who look for a fault: nothing is linked.
    assert run(copy, tmp_path / "cache", NUMBA_DISABLE_JIT="1") == "8 compiled"
    assert kept(tmp_path / "cache") == [file]


def test_without_any_place_each_start_compiles_and_says_so(copy, tmp_path):
    (tmp_path / "cache").touch()
    told = run(copy, tmp_path / "cache")
    assert told.startswith("8 compiled compiled kernels cannot be kept on disk (")
    assert "NUMBA_CACHE_DIR" in told


CODE = ObjectCode(b"code", "wrapper", "environment", ("<f8",), (), ("sqrt",))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    return tmp_path


def test_the_folder_of_ones_choice_has_the_kernel_as_it_is_now(folder):
    assert not kernel_store.has_any()
    kernel_store.write("a.module", "first", "its text", CODE)
    assert kernel_store.has_any()
    assert kernel_store.read("a.module", "first", "its text") == CODE
    kernel_store.write("a.module", "second", "its text", CODE)
    kernel_store.write("a.module", "first", "another text", CODE)
    assert kernel_store.read("a.module", "first", "its text") is None
    assert [file.name.partition(".")[0] for file in folder.rglob("*.kernel")] == [
        "module",
        "module",
    ]


def test_another_setting_of_numba_has_code_of_its_own(folder, monkeypatch):
    kernel_store.write("a.module", "first", "its text", CODE)
    monkeypatch.setenv("NUMBA_OPT", "1")
    assert not kernel_store.has_any()
    kernel_store.write("a.module", "first", "its text", CODE)
    monkeypatch.delenv("NUMBA_OPT")
    assert kernel_store.read("a.module", "first", "its text") == CODE
    assert len(list(folder.rglob("*.kernel"))) == 2


def test_a_file_that_is_cut_short_is_none_and_one_that_cannot_be_written_leaves_nothing(
    folder, monkeypatch
):
    kernel_store.write("a.module", "first", "its text", CODE)
    (file,) = folder.rglob("*.kernel")
    file.write_bytes(file.read_bytes()[:-1])
    assert kernel_store.read("a.module", "first", "its text") is None

    def full(self, target):
        raise OSError("No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(OSError, match="No space left"):
        kernel_store.write("a.module", "first", "its text", CODE)
    assert list(folder.rglob("*.*")) == [file]
