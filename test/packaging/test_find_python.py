# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The choice of the interpreter for `make`, among made-up ones."""

import subprocess
import sys
from pathlib import Path

import pytest

FIND = Path(__file__).resolve().parents[2] / ".ci" / "find-python"
OWN = f"{sys.version_info.major}.{sys.version_info.minor}"

STUB = "#!/bin/sh\necho 'command not found' >&2\nexit 127\n"  # what version managers leave
WITHOUT_VENV = '#!/bin/sh\ncase "$2" in *ensurepip*) exit 1;; esac\necho "$0"\n'
REAL = f'#!/bin/sh\nexec {sys.executable} "$@"\n'


@pytest.fixture
def find(tmp_path):
    def run(*versions, **interpreters):
        for name, text in interpreters.items():
            path = tmp_path / name.replace("_", ".")
            path.write_text(text)
            path.chmod(0o755)
        return subprocess.run(
            ["/bin/sh", FIND, *versions], env={"PATH": str(tmp_path)}, text=True,
            capture_output=True, check=False,
        )  # fmt: skip

    return run


def test_a_stub_is_passed_over_for_one_that_runs(find):
    done = find("2.9", OWN, python2_9=STUB, python3=REAL)
    assert (done.returncode, done.stdout.strip()) == (0, sys.executable)


def test_the_plain_name_counts_when_its_version_fits(find):
    assert find(OWN, python=REAL).returncode == 0
    assert find("3.9", python=REAL).returncode == 1


def test_the_missing_venv_package_is_named(find):
    done = find("3.12", python3_12=WITHOUT_VENV)
    assert done.returncode == 1
    assert "apt install python3.12-venv" in done.stderr


def test_none_at_all_is_told_with_the_remedy(find):
    done = find()
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert "3.12 3.13 3.11 3.10" in done.stderr
    assert "make PYTHON=" in done.stderr


@pytest.mark.parametrize("version", ["3.9", "3.14", "2.7"])
def test_an_interpreter_of_another_version_is_refused_before_anything_is_made(tmp_path, version):
    python = tmp_path / "python"
    python.write_text(f"#!/bin/sh\necho {version}\n")
    python.chmod(0o755)
    command = ["/bin/sh", FIND.with_name("make-venv"), tmp_path / "made", "lock.txt", python]
    done = subprocess.run(command, text=True, capture_output=True, check=False)
    assert done.returncode == 1
    assert f"is Python {version}, and the locked versions are for 3.10 to 3.13" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "made").exists()
