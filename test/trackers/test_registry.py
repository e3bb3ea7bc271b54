# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The registry: one entry per variant, whose module is imported only when it is needed."""

import subprocess
import sys
import types

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.trackers.base import BaseTracker
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

MODULES = {f"vehicle_pf_tracker.trackers{one.classes.split(':')[0]}" for one in VARIANTS.values()}


def loaded_by(program: str) -> set[str]:
    """Names of all modules in a new interpreter after `program`."""
    program = f"import sys\n{program}\nprint(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    return set(done.stdout.splitlines()[-1].split())


@pytest.mark.parametrize("variant", VARIANTS.values(), ids=list(VARIANTS))
def test_an_entry_leads_to_a_tracker_and_its_parameters(variant):
    assert issubclass(variant.tracker, BaseTracker)
    assert "evidence.minimum" in specs(variant.parameters)
    assert isinstance(variant.tracker(variant.parameters()), variant.tracker)


def test_the_registry_itself_needs_no_library():
    modules = loaded_by("import vehicle_pf_tracker.trackers.registry")
    assert {name.partition(".")[0] for name in modules}.isdisjoint({"numpy", "cv2", "yaml"})


@pytest.mark.parametrize("name", ["pf", "sfpf_edge", "fusion"])
def test_a_session_imports_its_own_variant_only(name):
    modules = loaded_by(
        "from vehicle_pf_tracker.parameters.configuration import Configuration\n"
        "from vehicle_pf_tracker.trackers.registry import find_variant\n"
        "from vehicle_pf_tracker.trackers.session import Session\n"
        f"variant = find_variant({name!r})\n"
        "Session(variant, Configuration.of(variant).tracker)"
    )
    own = find_variant(name).tracker.__module__
    # `sfpf` is three of the four filters of `mfpf`'s paper.
    parents = {"vehicle_pf_tracker.trackers.papers.mfpf"} if name.startswith("sfpf") else set()
    fusion = {one for one in modules if one.startswith("vehicle_pf_tracker.trackers.fusion")}
    assert own in modules
    assert (modules & MODULES) - parents - fusion == {own} - fusion
    assert bool(fusion) == (name == "fusion")


def test_a_node_imports_its_own_variant_only():
    pytest.importorskip("rclpy", reason="ROS 2 is not installed")
    modules = loaded_by(
        "import rclpy\n"
        "from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode\n"
        "from vehicle_pf_tracker.trackers.registry import find_variant\n"
        "rclpy.init()\n"
        "TrackerNode(find_variant('pf')).destroy_node()\n"
        "rclpy.shutdown()"
    )
    assert modules & MODULES == {"vehicle_pf_tracker.trackers.papers.pf"}


def test_an_unknown_name_is_answered_with_the_known_ones():
    with pytest.raises(InputError, match=r"no variant 'kalman'; choose one of apf, pf, "):
        find_variant("kalman")


def test_parameters_that_are_no_dataclass_are_named(monkeypatch):
    module = types.ModuleType("odd_plug_in")
    module.OddTracker, module.OddParameters = object, type("OddParameters", (), {})
    monkeypatch.setitem(sys.modules, "odd_plug_in", module)
    with pytest.raises(InputError, match="OddParameters is not a dataclass"):
        _ = Variant("odd", "odd_plug_in:Odd", "plug-in of odd 1.0", "").parameters
