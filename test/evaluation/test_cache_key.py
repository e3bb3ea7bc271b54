# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Digest of the code that a run needs, by which kept runs are run again."""

import pytest

from vehicle_pf_tracker.evaluation.cache_key import source_digest

COUNTS = {
    "core/box.py": True,
    "image/windows/window.py": True,
    "image/patches/learnt.npz": True,
    "detection/blobs.py": True,
    "trackers/base.py": True,
    "trackers/papers/own.py": True,
    "trackers/papers/beside.py": True,
    "trackers/fusion/other.py": False,
    "cli/verb.py": False,
}


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package of a name of its own, since a package that was imported stays."""
    package = tmp_path / f"made_{tmp_path.name}"
    for name in (*COUNTS, "__init__.py", "trackers/__init__.py", "trackers/papers/__init__.py"):
        file = package / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("X = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    source_digest.cache_clear()
    yield package
    source_digest.cache_clear()


@pytest.mark.parametrize(("name", "counts"), COUNTS.items())
def test_a_key_depends_on_the_code_that_a_run_needs(package, name, counts):
    own = frozenset({f"{package.name}.trackers.papers.own"})
    before = source_digest(own, package)
    (package / name).write_text("X = 2\n")
    source_digest.cache_clear()
    assert (source_digest(own, package) != before) == counts


def test_a_start_that_is_not_there_is_an_error(package):
    with pytest.raises(ModuleNotFoundError, match="gone"):
        source_digest(frozenset({f"{package.name}.trackers.gone"}), package)


@pytest.mark.parametrize("name", ["plugged", "plugs.cells"])
def test_a_plug_in_counts_where_it_is_installed(tmp_path, monkeypatch, name):
    file = tmp_path.joinpath(*name.split(".")).with_suffix(".py")
    file.parent.mkdir(exist_ok=True)
    monkeypatch.syspath_prepend(tmp_path)
    digests = set()
    for text in ("X = 1\n", "X = 2\n"):
        file.write_text(text)
        source_digest.cache_clear()
        digests.add(source_digest(frozenset({name})))
    assert len(digests) == 2
