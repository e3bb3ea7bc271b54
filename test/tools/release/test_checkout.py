# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The checks of a checkout, on one that is made wrong piece by piece."""

import subprocess

import pytest

from tools.release.checkout import STATED, check_clean, check_version
from tools.release.commands import ReleaseError

VERSION = "1.2.3"


@pytest.fixture
def root(tmp_path):
    """A checkout whose files agree, committed."""
    (tmp_path / "docs").mkdir()
    (tmp_path / "package.xml").write_text(f"<package><version>{VERSION}</version></package>")
    (tmp_path / "CHANGELOG.rst").write_text(f"Changes\n\n{VERSION}\n-----\n\n1.0.0\n-----\n")
    (tmp_path / "CITATION.cff").write_text(f"cff-version: 1.2.0\nversion: {VERSION}\n")
    page = f"Measured: vehicle pf tracker {VERSION}, python\n"
    (tmp_path / "docs" / "performance.md").write_text(page)
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "a")
    return tmp_path


def git(root, *words):
    subprocess.run(["git", *words], cwd=root, check=True)


def test_a_checkout_that_agrees_holds(root):
    assert check_clean(root)
    assert check_version(root) == VERSION


def test_what_is_not_committed_is_named(root):
    (root / "left.txt").touch()
    with pytest.raises(ReleaseError, match=r"not clean: left\.txt"):
        check_clean(root)


@pytest.mark.parametrize("name", STATED)
def test_a_file_of_another_version_is_named(root, name):
    (root / name).write_text((root / name).read_text().replace(VERSION, "1.2.2"))
    with pytest.raises(ReleaseError, match=rf"{name} has 1\.2\.2, not 1\.2\.3"):
        check_version(root)


def test_the_files_that_state_a_version_are_these():
    assert set(STATED) == {"CHANGELOG.rst", "CITATION.cff", "docs/performance.md"}


def test_a_version_is_tagged_once(root):
    git(root, "tag", f"v{VERSION}")
    with pytest.raises(ReleaseError, match="tagged already"):
        check_version(root)
