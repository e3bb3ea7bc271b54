# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The checks before a release, on a checkout and archives that are made wrong one by one."""

import subprocess
import tarfile
import zipfile

import pytest

from tools import release_check
from tools.release_check import Licence, ReleaseError

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
    assert release_check.check_clean(root)
    assert release_check.check_version(root) == VERSION


def test_what_is_not_committed_is_named(root):
    (root / "left.txt").touch()
    with pytest.raises(ReleaseError, match=r"not clean: left\.txt"):
        release_check.check_clean(root)


@pytest.mark.parametrize("name", ["CHANGELOG.rst", "CITATION.cff", "docs/performance.md"])
def test_a_file_of_another_version_is_named(root, name):
    (root / name).write_text((root / name).read_text().replace(VERSION, "1.2.2"))
    with pytest.raises(ReleaseError, match=rf"{name} has 1\.2\.2, not 1\.2\.3"):
        release_check.check_version(root)


def test_a_version_is_tagged_once(root):
    git(root, "tag", f"v{VERSION}")
    with pytest.raises(ReleaseError, match="tagged already"):
        release_check.check_version(root)


def test_archives_have_the_licence(tmp_path):
    with pytest.raises(ReleaseError, match=r"whl is not there: `make dist`"):
        release_check.archives(tmp_path, VERSION)
    stem = f"vehicle_pf_tracker-{VERSION}"
    (tmp_path / "LICENSE").touch()
    with tarfile.open(tmp_path / f"{stem}.tar.gz", "w:gz") as made:
        made.add(tmp_path / "LICENSE", f"{stem}/LICENSE")
    with zipfile.ZipFile(tmp_path / f"{stem}-py3-none-any.whl", "w") as made:
        made.writestr("vehicle_pf_tracker/__init__.py", "")
    with pytest.raises(ReleaseError, match=r"any\.whl has no LICENSE"):
        release_check.archives(tmp_path, VERSION)


def test_a_distribution_without_a_licence_is_named():
    good = [Licence("a", "1", "MIT", 0), Licence("b", "1", "", 2)]
    assert release_check.check_licences(good) == "a 1: MIT; b 1: see its file"
    of_ros = Licence("std_srvs", "1", "", 0), Licence("ros-rclpy", "1", "", 0)
    assert release_check.check_licences([*good, *of_ros]) == "a 1: MIT; b 1: see its file"
    with pytest.raises(ReleaseError, match=r"no licence: c$"):
        release_check.check_licences([*good, Licence("c", "1", "", 0)])


def test_each_version_of_python_has_each_extra(tmp_path):
    names = [name for name, _ in release_check.checks(tmp_path, ["video", "ros"], ["3.10", "3.13"])]
    assert names[4:] == [
        "wheel [video] with Python 3.10", "wheel [ros] with Python 3.10",
        "wheel [video] with Python 3.13", "wheel [ros] with Python 3.13", "source [video]",
    ]  # fmt: skip
    with pytest.raises(ReleaseError, match=r"looked for 2\.5"):
        release_check.interpreter("2.5")


def test_the_status_says_whether_all_holds(monkeypatch, tmp_path, capsys):
    def fail():
        raise ReleaseError("it is not")

    asked = []

    def checks(*given):
        asked.append(given)
        yield "one", fail
        yield "two", lambda: "it is"

    monkeypatch.setattr(release_check, "checks", checks)
    assert release_check.main([str(tmp_path), "--extras"]) == 1
    assert capsys.readouterr().out == "one: FAILED: it is not\ntwo: ok, it is\n"
    assert asked == [(tmp_path, [], [None])]
