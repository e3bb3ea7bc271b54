# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The order of the checks before a release, and the status of the program."""

from tools import release_check
from tools.release import installation, journeys
from tools.release.commands import ReleaseError
from tools.release_check import Check


def test_each_version_of_python_has_each_extra(tmp_path):
    names = [name for name, _ in release_check.checks(tmp_path, ["video", "ros"], ["3.10", "3.13"])]
    assert names[4:] == [
        "wheel [video] with Python 3.10", "wheel [ros] with Python 3.10",
        "wheel [video] with Python 3.13", "wheel [ros] with Python 3.13", "source [video]",
    ]  # fmt: skip


def test_without_extras_nothing_is_installed(tmp_path):
    names = [name for name, _ in release_check.checks(tmp_path, [])]
    assert names == ["clean tree", "version", "pages", "archives"]


def test_every_extra_of_the_readme_has_a_largest_size():
    assert set(installation.MOST_MEGABYTES) == set(journeys.WRITTEN)


def test_the_status_says_whether_all_holds(monkeypatch, tmp_path, capsys):
    def fail():
        raise ReleaseError("it is not")

    asked = []

    def checks(*given):
        asked.append(given)
        yield Check("one", fail)
        yield Check("two", lambda: "it is")

    monkeypatch.setattr(release_check, "checks", checks)
    assert release_check.main([str(tmp_path), "--extras"]) == 1
    assert capsys.readouterr().out == "one: FAILED: it is not\ntwo: ok, it is\n"
    assert asked == [(tmp_path, [], [None])]
