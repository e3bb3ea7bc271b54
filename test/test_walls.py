# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The walls of the house, read from the source: who may import whom, and who may use files."""

from __future__ import annotations

import ast
import sys

import pytest
from source_modules import (
    MESSAGES,
    NAME,
    ROS,
    Import,
    Module,
    covers,
    inside,
    made_up,
    own_modules,
)

GROUND = {"core", "road", "parameters", "filtering", "image"}
BELOW = {*GROUND, "detection", "trackers", "recordings", "scenes", "counting"}
FOLLOWING = {*BELOW, "results", "showing"}
MAY_IMPORT = {
    "core": set[str](),
    "road": {"core"},
    "parameters": {"core", "road"},
    "filtering": {"core", "road", "parameters"},
    "image": GROUND - {"image"},
    "detection": GROUND,
    "trackers": {*GROUND, "detection"},
    "recordings": GROUND,
    "scenes": GROUND,
    "counting": {*GROUND, "detection", "trackers"},
    "results": BELOW,
    "workers": {"core", "results"},
    "showing": {*BELOW, "results"},
    "following": FOLLOWING,
    "ros": {*FOLLOWING, "following"} - {"scenes"},
    "evaluation": {*FOLLOWING, "following", "workers"},
    "cli": {*FOLLOWING, "following", "workers", "ros", "evaluation"},
}
"""The rooms below each room, from the ground up."""
BESIDE = {"reproduction", "benchmarks", "laboratory", "tools"}
"""Packages of the repository that are not installed, so that nothing may import them."""
ON_A_ROBOT = {
    "rclpy",
    "launch",
    "launch_ros",
    *MESSAGES,
    "numpy",
    "scipy",
    "cv2",
    "yaml",
    "numba",
    "llvmlite",
}
"""Modules that a robot has from apt, beside the standard library."""
WITHOUT_FILES = {"filtering", "detection", "trackers"}
"""Rooms that neither read or write files nor paint."""
FILES = {"fileinput", "glob", "io", "onnxruntime", "os", "pathlib", "shutil", "tempfile"}
CALLS = {
    "": {"open"},
    "cv2": {
        "FileStorage", "VideoCapture", "VideoWriter", "circle", "imread", "imwrite", "line",
        "polylines", "putText", "rectangle",
    },
    "np": {"fromfile", "load", "loadtxt", "memmap", "save", "savetxt", "savez"},
}  # fmt: skip
"""Functions for files and for painting, by the module that they are called from."""


def broken_walls(modules: dict[str, Module]) -> list[str]:
    """Imports that `MAY_IMPORT` forbids."""
    return [
        f"{module.at(found.line)} imports {found.name}"
        for module in modules.values()
        for found in module.imports
        if not allowed_here(module, found)
    ]


def allowed_here(module: Module, found: Import) -> bool:
    target = inside(found.name)
    if target is None:
        if found.name.partition(".")[0] in BESIDE:
            return False
        in_core = module.room not in {"ros", "cli"}
        return not (in_core and found.name.partition(".")[0] in ROS)
    if module.name == "__main__":
        return covers({"cli.main"}, target)
    if not module.name:  # the public names, imported when they are first used
        return not found.at_start
    if target.partition(".")[0] == "ros" and module.room == "cli":
        return not found.at_start
    is_room = target.partition(".")[0] in MAY_IMPORT
    return not is_room or covers({module.room, *MAY_IMPORT.get(module.room, ())}, target)


def files_and_painting(modules: dict[str, Module]) -> list[str]:
    """Imports and calls for files or painting, in rooms that have neither."""
    rows = []
    for module in modules.values():
        if module.room not in WITHOUT_FILES:
            continue
        rows += [
            f"{module.at(found.line)} imports {found.name}"
            for found in module.imports
            if covers(FILES, found.name)
        ]
        rows += [
            f"{module.at(node.lineno)} calls {ast.unparse(node.func)}"
            for node in ast.walk(module.tree)
            if isinstance(node, ast.Call) and is_for_files_or_painting(node.func)
        ]
    return rows


def is_for_files_or_painting(function: ast.expr) -> bool:
    owner, _, name = ast.unparse(function).rpartition(".")
    return name in CALLS.get(owner, ())


def node_closure(modules: dict[str, Module]) -> set[str]:
    """Names of all modules of the package that starting a node may load, packages included.

    A replay is no node of a robot: it reads recordings, with the readers that this takes.
    """
    waiting = [
        name
        for name, module in modules.items()
        if module.room == "ros" and not covers({"ros.replay"}, name)
    ]
    seen: set[str] = set()
    while waiting:
        name = waiting.pop()
        if name in modules and name not in seen:
            seen.add(name)
            waiting.append(name.rpartition(".")[0])
            for found in modules[name].imports:
                target = inside(found.name)
                if target is not None and (name or found.at_start):
                    waiting += [target, target.rpartition(".")[0]]
    return seen


def missing_on_a_robot(modules: dict[str, Module]) -> list[str]:
    """Imports of the node's modules that a robot does not have from apt."""
    allowed = {*ON_A_ROBOT, *sys.stdlib_module_names, NAME}
    return [
        f"{modules[name].at(found.line)} imports {found.name}"
        for name in sorted(node_closure(modules))
        for found in modules[name].imports
        if found.name.partition(".")[0] not in allowed
    ]


@pytest.fixture(scope="module")
def modules() -> dict[str, Module]:
    return own_modules()


def test_every_room_is_known(modules):
    rooms = {module.room for name, module in modules.items() if "." in name}
    assert rooms == set(MAY_IMPORT)


def test_nothing_reaches_through_a_wall(modules):
    assert broken_walls(modules) == []


def test_trackers_neither_use_files_nor_paint(modules):
    assert files_and_painting(modules) == []


def test_node_and_replay_do_not_import_each_other(modules):
    sides = {"ros.node": "ros.replay", "ros.replay": "ros.node"}
    assert not [
        f"{module.at(found.line)} imports {found.name}"
        for name, module in modules.items()
        for side, other in sides.items()
        for found in module.imports
        if covers({side}, name) and covers({other}, inside(found.name) or "")
    ]


def test_nodes_import_only_what_a_robot_has(modules):
    assert missing_on_a_robot(modules) == []


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("filtering__weights", "import rclpy"),
        ("recordings__reader", "def read():\n    from sensor_msgs.msg import Image"),
        ("evaluation__tables", "from geometry_msgs import msg"),
        ("filtering__weights", "from vehicle_pf_tracker.image import window"),
        ("filtering__weights", "from vehicle_pf_tracker import image"),
        ("filtering__weights", "import vehicle_pf_tracker.image.window"),
        ("core__box", "from vehicle_pf_tracker.parameters.table import parameter"),
        ("parameters__configuration", "from ..trackers.registry import Variant"),
        ("image__window", "from ..trackers.base import Tracker"),
        ("image__window", "from .. import cli"),
        ("trackers__apf", "from vehicle_pf_tracker.recordings.bags.reader import Recording"),
        ("trackers__apf", "def late():\n    import vehicle_pf_tracker.scenes"),
        ("detection__blobs", "from vehicle_pf_tracker.trackers.estimate import Mode"),
        ("recordings__reader", "from vehicle_pf_tracker.trackers.estimate import Mode"),
        ("scenes__road", "from vehicle_pf_tracker.recordings.bags.writer import write"),
        ("scenes__road", "from vehicle_pf_tracker.recordings import writer"),
        ("scenes__road", "from vehicle_pf_tracker.trackers.registry import VARIANTS"),
        ("evaluation__tables", "from vehicle_pf_tracker.ros.node.tracker_node import Node"),
        ("evaluation__tables", "from vehicle_pf_tracker.cli.main import main"),
        ("ros__node", "from vehicle_pf_tracker.evaluation.scores import Scores"),
        ("following__driver", "from vehicle_pf_tracker.evaluation.scores import Scores"),
        ("ros__node", "from vehicle_pf_tracker.cli.main import main"),
        ("evaluation__tables", "from reproduction.experiment import Verdict"),
        ("cli__replay", "from vehicle_pf_tracker.ros.replay.player import play"),
        ("cli__replay", "import math\nif math.pi:\n    from vehicle_pf_tracker import ros"),
        ("cli__replay", "class Verb:\n    from vehicle_pf_tracker.ros.replay.player import play"),
    ],
)
def test_checker_sees_a_broken_wall(tmp_path, file, line):
    assert len(broken_walls(made_up(tmp_path, **{file: line}))) == 1


@pytest.mark.parametrize(
    ("file", "line"),
    [
        (
            "filtering__weights",
            "import numpy as np\nfrom . import motion\nfrom .motion import step",
        ),
        ("trackers__apf", "from ..filtering.weights import normalised"),
        ("trackers__apf", "from vehicle_pf_tracker.core.box import Box"),
        ("scenes__road", "from vehicle_pf_tracker.core.truth import Truth"),
        ("scenes__road", "from vehicle_pf_tracker.parameters.table import specs"),
        ("evaluation__runs", "from vehicle_pf_tracker import __version__"),
        ("cli__replay", "def run():\n    from vehicle_pf_tracker.ros.replay.player import play"),
        ("cli__main", "from vehicle_pf_tracker.cli import replay"),
        ("ros__node", "import rclpy\nfrom sensor_msgs.msg import Image"),
    ],
)
def test_checker_lets_the_permitted_pass(tmp_path, file, line):
    assert broken_walls(made_up(tmp_path, **{file: line})) == []


@pytest.mark.parametrize(
    ("file", "line", "count"),
    [
        ("trackers__apf", "from pathlib import Path", 1),
        ("trackers__apf", "def late():\n    import os.path", 1),
        ("trackers__apf", "def read(name):\n    return open(name)", 1),
        ("trackers__apf", "import cv2\ncv2.putText(picture, 'a', (0, 0), 1, 1, 1)", 1),
        ("filtering__weights", "import numpy as np\nweights = np.load('weights.npy')", 1),
        ("trackers__apf", "import cv2\ncv2.cvtColor(picture, 1)\nstream.open()\nstream.line()", 0),
        ("evaluation__drawing", "from pathlib import Path\nopen('a')", 0),
    ],
)
def test_checker_sees_files_and_painting(tmp_path, file, line, count):
    assert len(files_and_painting(made_up(tmp_path, **{file: line}))) == count


def test_checker_follows_the_node_to_what_it_loads(tmp_path):
    modules = made_up(
        tmp_path,
        ros__node="import rclpy, json\nfrom vehicle_pf_tracker.trackers import apf",
        trackers____init__="from .plots import draw",
        trackers__apf="import numpy",
        trackers__plots="def draw():\n    import matplotlib.pyplot",
        evaluation__tables="import rich",
    )
    assert missing_on_a_robot(modules) == ["plots.py:2 (trackers.plots) imports matplotlib.pyplot"]
