# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory of libraries, given back in a process of its own: its pages are not the tests'."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from vehicle_pf_tracker.ros import library_memory

_GIVEN_BACK = """
from pathlib import Path
import numpy as np
from vehicle_pf_tracker.ros.library_memory import give_back_library

def resident():
    line = next(one for one in Path("/proc/self/smaps_rollup").open() if one.startswith("Rss:"))
    return int(line.split()[1])

generator = np.random.default_rng(0)
numbers = generator.random(1000)
before = resident()
given = give_back_library("_multiarray_umath")
assert given > 1000, given
assert before - resident() > given / 2
assert np.sort(numbers)[0] == numbers.min()
assert (np.random.default_rng(0).random(1000) == numbers).all()
assert give_back_library("no such library") == 0
"""


@pytest.mark.skipif(not Path("/proc/self/smaps").exists(), reason="the system is not Linux")
def test_a_library_whose_pages_were_given_back_works_on():
    subprocess.run([sys.executable, "-c", _GIVEN_BACK], check=True)


def test_a_system_without_a_list_of_pages_gives_nothing_back(monkeypatch, tmp_path):
    monkeypatch.setattr(library_memory, "SMAPS", tmp_path / "smaps")
    assert library_memory.give_back_library("_multiarray_umath") == 0


def test_what_the_loader_changed_is_kept(monkeypatch, tmp_path):
    areas = {
        "1000-2000 r-xp": (0, 0),
        "2000-3000 rw-p": (0, 0),
        "3000-4000 r--p": (4, 0),
        "4000-5000 r--p": (0, 4),
    }
    smaps = tmp_path / "smaps"
    smaps.write_text(
        "".join(
            f"{area} 00000000 fe:00 1   /lib/libone.so\nRss: 4 kB\nAnonymous: {anonymous} kB\n"
            f"Swap: {swapped} kB\nVmFlags: rd\n"
            for area, (anonymous, swapped) in areas.items()
        )
    )
    monkeypatch.setattr(library_memory, "SMAPS", smaps)
    found = list(library_memory.unchanged_areas("libone"))
    assert found == [(0x1000, 0x2000, 4)]
    assert not list(library_memory.unchanged_areas("libother"))


def test_what_a_system_does_not_say_is_taken_for_changed(monkeypatch, tmp_path):
    smaps = tmp_path / "smaps"
    smaps.write_text("1000-2000 r-xp 00000000 fe:00 1   /lib/libone.so\nRss: 4 kB\nSwap: 0 kB\n")
    monkeypatch.setattr(library_memory, "SMAPS", smaps)
    assert not list(library_memory.unchanged_areas("libone"))


def test_a_list_of_pages_that_cannot_be_read_gives_nothing_back(monkeypatch, tmp_path):
    monkeypatch.setattr(library_memory, "SMAPS", tmp_path)  # a folder, which no user can read
    assert library_memory.give_back_library("_multiarray_umath") == 0
