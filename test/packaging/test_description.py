# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The facts that package.xml, setup.py, the locks and the code state in common."""

import re
import runpy
import sys
import xml.etree.ElementTree as ET
from configparser import ConfigParser
from pathlib import Path

import pytest
import setuptools

import vehicle_pf_tracker
from vehicle_pf_tracker.cli.missing_modules import EVALUATION_MODULES, EXTRAS
from vehicle_pf_tracker.evaluation.baseline_process import BASELINES_LOCK
from vehicle_pf_tracker.ros import executables
from vehicle_pf_tracker.trackers.registry import NODES

ROOT = Path(__file__).resolve().parents[2]


def described(monkeypatch, *command):
    """The arguments of setup() when setup.py is run with this command."""
    arguments = {}
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", ["setup.py", *command])
    monkeypatch.setattr(setuptools, "setup", arguments.update)
    runpy.run_path("setup.py", run_name="__main__")
    return arguments


@pytest.fixture
def setup(monkeypatch):
    return described(monkeypatch, "bdist_wheel")


@pytest.fixture
def package():
    return ET.parse(ROOT / "package.xml").getroot()


def locked(name, *, marked=True):
    """(name, version) of each pin in a lock file, with or without those for some Pythons only."""
    lines = (ROOT / "requirements" / f"{name}.txt").read_text().splitlines()
    pins = [line for line in lines if "==" in line and (marked or ";" not in line)]
    return {tuple(pin.partition(";")[0].strip(" \\").lower().split("==")) for pin in pins}


def test_name_version_and_licence_are_the_same_everywhere(setup, package):
    version = package.findtext("version")
    assert setup["version"] == vehicle_pf_tracker.__version__ == version
    assert re.search(rf"^{re.escape(version)}\n-+$", (ROOT / "CHANGELOG.rst").read_text(), re.M)
    assert f"version: {version}" in (ROOT / "CITATION.cff").read_text()
    assert setup["name"] == vehicle_pf_tracker.__name__
    assert setup["license"] == "Apache-2.0"
    assert "Apache License" in (ROOT / package.find("license").get("file")).read_text()


def test_an_older_python_gets_one_sentence(monkeypatch):
    monkeypatch.setattr(sys, "version_info", (3, 9, 18, "final", 0))
    with pytest.raises(SystemExit, match=r"needs Python 3\.10 or newer, and this is 3\.9: use "):
        described(monkeypatch, "egg_info")


def test_modules_that_may_be_missing_name_an_extra_that_brings_them(setup):
    for module, extra in EXTRAS.items():
        names = {re.match(r"[\w.-]+", one)[0] for one in setup["extras_require"][extra]}
        assert module in names


def test_every_registered_node_has_an_executable(setup):
    scripts = dict(line.split(" = ") for line in setup["entry_points"]["console_scripts"])
    nodes = {name: target for name, target in scripts.items() if name.endswith("_tracker")}
    assert nodes == {
        f"{name}_tracker": "vehicle_pf_tracker.ros.executables:main" for name in [*NODES, "vehicle"]
    }
    assert callable(executables.main)


def test_layouts_of_viewers_are_installed(setup):
    viewers = dict(setup["data_files"])["share/vehicle_pf_tracker/viewers"]
    assert sorted(viewers) == sorted(map(str, Path("viewers").iterdir()))
    assert len(viewers) == 4


def test_executables_are_installed_where_ros2_run_looks():
    config = ConfigParser()
    config.read(ROOT / "setup.cfg")
    folder = "$base/lib/vehicle_pf_tracker"
    assert config["develop"]["script_dir"] == config["install"]["install_scripts"] == folder


@pytest.mark.parametrize("command", [("install",), ("egg_info", "build", "install"), ("develop",)])
def test_a_build_for_ros_leaves_the_libraries_to_apt(monkeypatch, command):
    assert described(monkeypatch, *command)["install_requires"] == []


@pytest.mark.parametrize("command", ["bdist_wheel", "editable_wheel", "dist_info", "egg_info"])
def test_pip_installs_the_libraries(monkeypatch, command):
    names = {
        re.match(r"[\w-]+", line)[0] for line in described(monkeypatch, command)["install_requires"]
    }
    assert {"numpy", "opencv-python-headless", "mcap", "rosbags", "PyYAML"} <= names
    assert not {"matplotlib", "scipy", "jinja2"} & names


def test_the_extra_of_evaluations_is_what_its_verbs_ask_for(setup):
    extra = setup["extras_require"]["evaluation"]
    assert {re.match(r"[\w-]+", line)[0] for line in extra} >= {*EVALUATION_MODULES, "optuna"}


def test_extras_bring_what_the_readme_shows(setup):
    extras = setup["extras_require"]
    assert set(extras) == {"video", "ros", "evaluation", "numba", "cluster", "test", "lint", "dev"}
    assert set(extras["video"]) <= set(extras["evaluation"])
    for extra in ("video", "ros"):
        assert {"scipy>=1.11", "onnxruntime>=1.17"} <= set(extras[extra])


@pytest.mark.parametrize(
    "path", [*sorted((ROOT / "requirements").glob("*.txt")), BASELINES_LOCK], ids=lambda p: p.stem
)
def test_every_pin_has_hashes_and_no_lock_names_an_index(path):
    pins = re.findall(r"^\S+==.*(?:\n    .*)*", path.read_text(), re.M)
    assert pins
    assert all(re.search(r"--hash=sha256:[0-9a-f]{64}\b", pin) for pin in pins)
    assert "://" not in path.read_text()


def test_hashes_are_checked():
    assert "--require-hashes" in (ROOT / ".ci" / "make-venv").read_text()


def test_the_ros_extra_is_locked_at_the_same_versions(setup):
    pins = {
        (re.match(r"[\w-]+", line)[0], re.search(r"==([\d.]+);", line)[1])
        for line in setup["extras_require"]["ros"]
        if "ros-" in line
    }
    assert pins <= locked("ros-jazzy")


@pytest.mark.parametrize("environment", [("locked", "ros-jazzy", "colcon"), ("noble", "ros-jazzy")])
def test_no_package_is_locked_in_two_versions(environment):
    names = [name for name, _ in set().union(*(locked(part, marked=False) for part in environment))]
    assert sorted(names) == sorted(set(names))


def test_ubuntu_noble_is_tried_with_its_own_numpy_and_opencv():
    assert {("numpy", "1.26.4"), ("opencv-python-headless", "4.6.0.66")} <= locked("noble")


def test_package_xml_names_the_message_packages_that_the_code_imports(package):
    source = "\n".join(path.read_text() for path in (ROOT / "vehicle_pf_tracker").rglob("*.py"))
    messages = set(
        re.findall(r"^\s*(?:from|import) (\w+_msgs|\w+_interfaces|\w+_srvs)\b", source, re.M)
    )
    stated = {depend.text for depend in package.findall("exec_depend")}
    assert messages <= stated
    assert "rclpy" in stated


def test_package_xml_leaves_what_only_evaluations_need(package):
    stated = {depend.text for depend in package.findall("exec_depend")}
    only = set(EVALUATION_MODULES) - {"scipy"}  # traffic_tracker assigns with it
    assert not {f"python3-{name}" for name in only} & stated


def test_package_xml_declares_aments_linters(package):
    stated = {depend.text for depend in package.findall("test_depend")}
    assert {"ament_flake8", "ament_pep257", "ament_xmllint"} <= stated
