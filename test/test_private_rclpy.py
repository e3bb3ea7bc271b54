# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Private parts of rclpy are named in one module, and none is hidden by a name of ours."""

from __future__ import annotations

import ast
import inspect
import sys
from pathlib import Path

import pytest
from source_modules import ROS, Module, made_up, own_modules

INTERNALS = "ros.rclpy_internals"
"""The one module that may name private parts of rclpy."""


def private_parts_of_rclpy(modules: dict[str, Module]) -> list[str]:
    """Private names that a module with ROS in it does not define itself, and private imports."""
    rows = []
    for name, module in modules.items():
        heads = {found.name.partition(".")[0] for found in module.imports}
        if name == INTERNALS or ROS.isdisjoint(heads):
            continue
        own = names_defined(module.tree)
        rows += [
            f"{module.at(node.lineno)} uses {node.attr}"
            for node in ast.walk(module.tree)
            if isinstance(node, ast.Attribute)
            and is_private(node.attr)
            and node.attr not in own
            and not (isinstance(node.value, ast.Name) and node.value.id in sys.stdlib_module_names)
        ]
        rows += [
            f"{module.at(found.line)} imports {found.name}"
            for found in module.imports
            if found.name.startswith(("rclpy.impl", "rclpy._"))
        ]
    return rows


def names_defined(tree: ast.Module) -> set[str]:
    """Names of the module's functions and classes, and of what its methods assign to ``self``."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            if isinstance(node.value, ast.Name) and node.value.id == "self":
                names.add(node.attr)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names |= {target.id for target in targets if isinstance(target, ast.Name)}
    return names


def is_private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__")


@pytest.fixture(scope="module")
def modules() -> dict[str, Module]:
    return own_modules()


def test_private_parts_of_rclpy_are_named_in_one_module(modules):
    assert private_parts_of_rclpy(modules) == []
    assert private_parts_of_rclpy({"other": Module("other", *modules[INTERNALS][1:])})


def test_no_class_of_ours_hides_a_private_name_of_rclpys_classes(modules):
    executors = pytest.importorskip("rclpy.executors")
    lifecycle = pytest.importorskip("rclpy.lifecycle")
    theirs = {
        node.attr
        for kind in (*lifecycle.LifecycleNode.__mro__, executors.SingleThreadedExecutor)
        if kind.__module__.startswith("rclpy")
        for node in ast.walk(ast.parse(Path(inspect.getfile(kind)).read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and is_private(node.attr)
    }
    assert "_parameter_overrides" in theirs
    heirs = (
        "ros.node.image_node", "ros.node.tracker_node",
        "ros.process", "ros.traffic.traffic_node",
    )  # fmt: skip
    for name in heirs:
        assert not names_defined(modules[name].tree) & theirs, name


@pytest.mark.parametrize(
    ("line", "count"),
    [
        ("from rclpy.node import Node\ndef f(node):\n    return node._parameters", 1),
        ("from rclpy.impl.implementation_singleton import rclpy_implementation", 1),
        ("import rclpy\nclass N(rclpy.node.Node):\n def f(self):\n  self._state_machine.x()", 1),
        ("import rclpy\nclass N:\n def f(self):\n  self._own = 1\n  self._own += self.f()", 0),
        ("from .own import thing\ndef f():\n    return thing._kept", 0),
    ],
)
def test_checker_sees_private_parts_of_rclpy(tmp_path, line, count):
    assert len(private_parts_of_rclpy(made_up(tmp_path, ros__node=line))) == count
