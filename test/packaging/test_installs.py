# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every way to install the package, tried for real: the code and its files are found in each."""

import os
import re
import shutil
import sys
import venv
from importlib.util import find_spec
from pathlib import Path

import pytest
import setuptools
from unmeasured import unmeasured_environment

from tools.release.commands import run
from tools.release.installation import check_installation
from tools.release.journeys import WRITTEN
from vehicle_pf_tracker.trackers.registry import NODES

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SHARE = Path("share", "vehicle_pf_tracker")
EXECUTABLES = {
    "vehicle-pf-tracker", "bag_replay", "video_source", "vehicle_tracker",
    *(f"{name}_tracker" for name in NODES),
}  # fmt: skip
ASK = "import vehicle_pf_tracker; print(vehicle_pf_tracker.__file__)"

needs_colcon = pytest.mark.skipif(
    find_spec("colcon_core") is None, reason="needs colcon: `make .venv/colcon`"
)


@pytest.fixture(scope="module", autouse=True)
def unmeasured():
    """pip and colcon run nothing of the package, and coverage would follow each of their lines."""
    with pytest.MonkeyPatch.context() as patch:
        for name in os.environ.keys() - unmeasured_environment().keys():
            patch.delenv(name)
        yield


def pip(*words, cwd, python=None, **variables):
    where = ["--python", python] if python else []
    quiet = ["--quiet", "--disable-pip-version-check"]
    return run(sys.executable, "-m", "pip", *where, *quiet, *words, cwd=cwd, **variables)


def asked(python, cwd, **variables):
    """Where this Python finds the package."""
    return Path(run(python, "-c", ASK, cwd=cwd, **variables).strip())


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A copy of the checkout with one more parameter file, which no other install can have."""
    copy = tmp_path_factory.mktemp("source") / "vehicle_pf_tracker"
    written = {"build", "install", "log", "results", "test"}  # at the top: a room has such a name
    unwanted = shutil.ignore_patterns(".*", "*.egg-info", "__pycache__")

    def left_out(folder, names):
        return unwanted(folder, names) | (written if Path(folder) == ROOT else set())

    shutil.copytree(ROOT, copy, ignore=left_out)
    (copy / "config").mkdir(exist_ok=True)
    (copy / "config" / "trial.yaml").write_text("/**:\n  ros__parameters: {}\n")
    return copy


@pytest.fixture(scope="module")
def wheel(source, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    pip("wheel", "--no-deps", "--no-build-isolation", "-w", folder, source, cwd=folder)
    return next(folder.glob("*.whl"))


def bare(folder, *, system_site_packages=False):
    """A Python that has nothing installed."""
    venv.create(folder, system_site_packages=system_site_packages, symlinks=True)
    return folder / "bin" / "python"


def test_pip(wheel, tmp_path):
    python = bare(tmp_path / "env")
    pip("install", "--no-deps", wheel, cwd=tmp_path, python=python)
    code = asked(python, tmp_path)
    assert code.is_relative_to(tmp_path / "env" / "lib")
    assert {path.name for path in (tmp_path / "env" / "bin").iterdir()} >= EXECUTABLES
    assert_share_is_complete(tmp_path / "env")


def test_pip_target(wheel, tmp_path):
    python = bare(tmp_path / "env")
    pip("install", "--no-deps", "--target", tmp_path / "lib", wheel, cwd=tmp_path)
    code = asked(python, tmp_path, PYTHONPATH=tmp_path / "lib")
    assert code.is_relative_to(tmp_path / "lib")
    assert_share_is_complete(tmp_path / "lib")


def test_pip_user(wheel, tmp_path):
    python = bare(tmp_path / "env", system_site_packages=True)
    home = {"PYTHONUSERBASE": tmp_path / "home"}
    pip("install", "--no-deps", "--user", "--ignore-installed", wheel,
        cwd=tmp_path, python=python, **home)  # fmt: skip
    code = asked(python, tmp_path, **home)
    assert code.is_relative_to(tmp_path / "home")
    assert_share_is_complete(tmp_path / "home")


def test_pip_editable(source, tmp_path):
    python = bare(tmp_path / "env")
    builder = {"PYTHONPATH": Path(setuptools.__file__).parents[1]}
    pip("install", "--no-deps", "--no-build-isolation", "--ignore-installed", "--editable", source,
        cwd=tmp_path, python=python, **builder)  # fmt: skip
    code = asked(python, tmp_path)
    assert code == source / "vehicle_pf_tracker" / "__init__.py"
    assert {path.name for path in (tmp_path / "env" / "bin").iterdir()} >= EXECUTABLES


@needs_colcon
def test_colcon(source, tmp_path):
    prefix = colcon_build(source, tmp_path)
    code = asked_in_workspace(tmp_path)
    assert code.is_relative_to(prefix / "lib")
    assert_share_is_complete(prefix)
    assert_ros_finds(prefix)


@needs_colcon
def test_colcon_symlink_install(source, tmp_path):
    prefix = colcon_build(source, tmp_path, "--symlink-install")
    code = asked_in_workspace(tmp_path)
    assert code.resolve() == source / "vehicle_pf_tracker" / "__init__.py"
    assert_share_is_complete(prefix)
    assert_ros_finds(prefix)


def colcon_build(source, workspace, *options):
    colcon = Path(sys.executable).with_name("colcon")
    run(colcon, "build", "--paths", source, *options, cwd=workspace)
    return workspace / "install" / "vehicle_pf_tracker"


def asked_in_workspace(workspace):
    """Where a shell that sourced the workspace finds the package."""
    command = '. install/setup.sh && exec "$0" -c "$1"'
    return Path(run("sh", "-c", command, sys.executable, ASK, cwd=workspace).strip())


def assert_share_is_complete(prefix):
    marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / SHARE.name
    files = {str(path.relative_to(prefix / SHARE)) for path in (prefix / SHARE).rglob("*.*")}
    assert marker.is_file()
    wanted = "package.xml", "launch/tracker.launch.py", "launch/replay.launch.py"
    assert {*wanted, "config/trial.yaml"} <= files


def assert_ros_finds(prefix):
    """`ros2 run` lists lib/<package>; what it starts must not ask for pip's name of a library."""
    folder = prefix / "lib" / "vehicle_pf_tracker"
    assert {path.name for path in folder.iterdir() if os.access(path, os.X_OK)} == EXECUTABLES
    stated = "import pkg_resources as p; print(p.get_distribution('vehicle_pf_tracker').requires())"
    command = f'. {prefix.parent}/setup.sh && exec "$0" -W ignore -c "$1"'
    assert run("sh", "-c", command, sys.executable, stated, cwd=prefix).strip() == "[]"


@pytest.mark.parametrize("extra", WRITTEN)
def test_an_extra_brings_all_that_the_readme_shows_for_it(wheel, extra):
    assert re.match(r"\d+ MB; .*numpy", check_installation(wheel, extra))
