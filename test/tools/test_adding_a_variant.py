# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Two files and an entry in the registry make a variant; everything else follows from them."""

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter

pytestmark = pytest.mark.slow  # the copy compiles its kernels

ROOT = Path(__file__).resolve().parents[2]
COPIED = ["vehicle_pf_tracker", "laboratory", "tools", "config", "docs", "launch", "resource"]
COPIED += ["test/trackers"]
FILES = ["setup.py", "setup.cfg", "package.xml", "pyproject.toml", "README.md", "conftest.py"]
FILES += [str(path.relative_to(ROOT)) for path in (ROOT / "test").glob("*.py")]

TRACKER = '''"""`toy`: a colour particle filter that is sure of its speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import log_likelihood


@dataclass(frozen=True, slots=True)
class ToyParameters(ColourParameters):
    """Parameters of `toy`."""

    trust: float = parameter(
        0.8, "Higher: spreads less.", bounds=(0.0, 0.9), tuned=(0.2, 0.8)
    )


class ToyTracker(ColourTracker[ToyParameters]):
    """A tracker for a test."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        settings = self.parameters
        spread = settings.sigma * (1 - settings.trust) * elapsed
        moved = self._resample(self._cloud) + np.asarray(self._velocity.value) * elapsed
        particles, left_image = self._diffuse(frame, moved, spread)
        rho = self.similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        return self._report(frame, cloud, elapsed, left_image=left_image)
'''

TEST = """from street import Street, error, follow

from vehicle_pf_tracker.trackers.papers.toy import ToyParameters, ToyTracker


def test_toy_follows_a_steady_vehicle():
    street = Street()
    estimates = follow(ToyTracker(ToyParameters()), street, range(30))
    assert error(estimates[-1], street, 29) < 5
"""

ENTRY = '    Variant("toy", ".papers.toy:Toy", "steady colour filter (nobody)", "tests"),\n'

EXECUTABLES = """
import runpy, setuptools
setuptools.setup = lambda **facts: print(*facts["entry_points"]["console_scripts"], sep="\\n")
runpy.run_path("setup.py", run_name="__main__")
"""
SEARCH = """
from vehicle_pf_tracker.evaluation.tuning_aims import default_search
from vehicle_pf_tracker.trackers.registry import find_variant
print(*default_search(find_variant("toy")))
"""
NODE = """
import sys
sys.argv = ["toy_tracker", "--help"]
from vehicle_pf_tracker.ros.executables import main
sys.exit(main())
"""


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy of the repository to which `toy` was added, with `make config` done."""
    root = tmp_path_factory.mktemp("checkout")
    for name in COPIED:
        shutil.copytree(ROOT / name, root / name)
    for name in FILES:
        shutil.copy2(ROOT / name, root / name)
    (root / "vehicle_pf_tracker/trackers/papers/toy.py").write_text(TRACKER)
    (root / "test/trackers/papers/test_toy.py").write_text(TEST)
    registry = root / "vehicle_pf_tracker/trackers/registry.py"
    before, entries, after = registry.read_text().partition("_ENTRIES = (\n")
    registry.write_text(before + entries + ENTRY + after)
    python(root, "-m", "tools.generate")
    return root


def python(root: Path, *words: object) -> str:
    """Run Python in the copy; returns what it printed."""
    done = subprocess.run(
        [sys.executable, *map(str, words)],
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_its_generated_files_are_there(checkout):
    assert "    trust: 0.8\n" in (checkout / "config/toy.yaml").read_text()
    policy = (checkout / "config/sros2_policy.xml").read_text()
    assert '<enclave path="/vehicle_pf_tracker/toy">' in policy
    assert 'node="toy_tracker"' in policy
    assert "\n## toy\n" in (checkout / "docs/parameters.md").read_text()
    for page in ("docs/choosing.md", "docs/variants.md"):
        assert "\n| `toy` | " in (checkout / page).read_text()


def test_it_tracks_from_the_command_line(checkout, tmp_path):
    with RecordingWriter(tmp_path / "recording") as writer:
        for index in range(5):
            frame = np.full((48, 64, 3), 100, np.uint8)
            frame[20:32, 20 + index : 36 + index] = (200, 30, 30)
            writer.write_image(index * 40_000_000, frame)
    main = "from vehicle_pf_tracker.cli.main import main; raise SystemExit(main())"
    python(
        checkout, "-c", main, "run", tmp_path / "recording", "--variant", "toy",
        "--target", "20,20,16,12", "-o", tmp_path / "out",
    )  # fmt: skip
    rows = (tmp_path / "out" / "estimates.csv").read_text().splitlines()
    assert len(rows) == 1 + 5


def test_it_has_an_executable(checkout):
    scripts = python(checkout, "-c", EXECUTABLES).splitlines()
    assert "toy_tracker = vehicle_pf_tracker.ros.executables:main" in scripts


def test_its_parameters_are_tuned(checkout):
    assert python(checkout, "-c", SEARCH).split()[-1] == "trust=0.2:0.8"


@pytest.mark.skipif(find_spec("rclpy") is None, reason="ROS 2 is not installed")
def test_its_executable_starts(checkout):
    assert "usage: toy_tracker" in python(checkout, "-c", NODE)


def test_it_conforms(checkout):
    words = ["-q", "-p", "no:cacheprovider", "-k", "toy", "test/trackers"]
    assert " passed" in python(checkout, "-m", "pytest", *words)
