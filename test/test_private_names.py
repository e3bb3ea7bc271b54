# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Private names that the package's tests reach for: few, and each with its reason."""

import ast
import re
from pathlib import Path

HOOKS = {
    "test_failing_tracker.py: _advance": "no image makes a tracker return numbers that are not",
    "test_kernel.py: _notices": "a process keeps its notices, and has those of other tests",
    "test_launch.py: _ExecuteLocal__emulate_tty": "launch tells nobody whether a node has one",
    "test_launch.py: _Node__arguments": "launch_ros tells nobody what a node is started with",
    "test_launch.py: _Node__parameters": "launch_ros tells nobody what a node is started with",
    "test_launch.py: _perform_substitutions": "launch_ros names a node only when it starts it",
    "test_node_executor.py: _compiled": "stands for an rclpy without it, bound at the import",
    "test_soak.py: _start": "the soak's nodes would be processes",
    "test_whole_kernels.py: _OF_LIBRARY": "stands for a numba without these names",
    "test_whole_kernels.py: _WRAPPER": "stands for a numba that names its wrappers otherwise",
    "test_whole_kernels.py: _codegen": "numba tells nobody of what it makes machine code",
    "test_whole_kernels.py: _finalize_final_module": "numba tells nobody of what it makes code",
    "test_whole_kernels.py: _library_class": "numba tells nobody of what it makes machine code",
}
"""Reason why a test needs what is not public, by file and name; make things public, or test them
through what is, before another one comes."""
SHOWN = {"_asdict", "_exit", "_fields", "_make", "_replace", "_repr_html_"}
"""Names with an underscore that their owners document."""
SETTERS = {"setattr", "delattr", "getattr", "setitem", "object", "patch"}
PRIVATE = re.compile(r"_[A-Za-z]\w*")
DOTTED = re.compile(r"[\w.]+\.(_[A-Za-z]\w*)")


def private_names(text: str) -> set[str]:
    """Name what a text takes from others though it is theirs: attributes, imports, patches."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Attribute) and not is_own(node.value):
            found.add(node.attr)
        elif isinstance(node, ast.ImportFrom):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in SETTERS:
            found |= {str(word.value) for word in node.args if isinstance(word, ast.Constant)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found |= {match[1]} if (match := DOTTED.fullmatch(node.value)) else set()
    return {name for name in found if PRIVATE.fullmatch(name)} - SHOWN


def is_own(owner: ast.expr) -> bool:
    return ast.unparse(owner) in {"self", "cls", "super()"}


def test_no_test_reaches_for_more_private_names_than_those_with_a_reason():
    found = {
        f"{path.name}: {name}"
        for path in Path(__file__).parent.rglob("*.py")
        for name in private_names(path.read_text(encoding="utf-8"))
    }
    assert found == set(HOOKS)


def test_each_way_to_a_private_name_is_noticed():
    assert private_names("from a import _b, c\n") == {"_b"}
    assert private_names("a._b = c._d.e\n") == {"_b", "_d"}
    assert private_names("patch.setattr(a, '_b', 1)\nmonkeypatch.setattr('a.b._c', 1)\n") == {
        "_b",
        "_c",
    }
    assert private_names("for name in ['a.b._c', 'x_y']: pass\n") == {"_c"}
    own = "class A:\n def f(self):\n  self._a = super()._b()\n  os._exit(self.c._replace(d=1))\n"
    assert private_names(own) == set()
