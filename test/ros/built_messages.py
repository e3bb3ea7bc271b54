# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

# ruff: noqa: PLC0415 - the generators are there only where the wheels are

"""Message packages that are not wheels, built from definitions with the generators that are.

An ament build does the same in CMake; here a handful of messages are built for C and Python alone.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Mapping
from pathlib import Path

import numpy as np

VISION = {
    "Point2D": "float64 x\nfloat64 y\n",
    "Pose2D": "vision_msgs/Point2D position\nfloat64 theta\n",
    "BoundingBox2D": "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y\n",
    "ObjectHypothesis": "string class_id\nfloat64 score\n",
    "ObjectHypothesisWithPose": (
        "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n"
    ),
    "Detection2D": (
        "std_msgs/Header header\nObjectHypothesisWithPose[] results\n"
        "BoundingBox2D bbox\nstring id\n"
    ),
    "Detection2DArray": "std_msgs/Header header\nDetection2D[] detections\n",
}
TF2 = {"TFMessage": "geometry_msgs/TransformStamped[] transforms\n"}

PREFIX = Path(sys.prefix)
NEEDED = ("std_msgs", "geometry_msgs", "builtin_interfaces")
SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")


def missing() -> str:
    """Say what a build lacks here; empty where there is all of it."""
    if not all(map(shutil.which, ("gcc", "g++"))):
        return "there is no C compiler"
    if not Path(sysconfig.get_paths()["include"], "Python.h").exists():
        return "there are no headers of Python"
    if not (PREFIX / "share" / "rosidl_generator_py" / "resource").exists():
        return "the generators are not those of the wheels"
    return ""


def build(package: str, messages: Mapping[str, str], folder: Path) -> Path:
    """Build `messages` (name: definition) in `folder`; returns what belongs on the path."""
    work = folder / package
    (work / "msg").mkdir(parents=True)
    for name, text in messages.items():
        (work / "msg" / f"{name}.msg").write_text(text)
    sources = _generate(package, list(messages), work)
    _write_visibility(package, work / "include" / package / "msg")
    objects = {group: _compile(files, work) for group, files in sources.items()}
    module = work / "python" / package
    own = f"-l{package}__rosidl_generator_c"
    _link(module / f"lib{package}__rosidl_generator_c.so", objects["c"])
    for support in SUPPORTS:
        _link(module / f"lib{package}__{support}.so", objects[support], own)
    python = [*objects["rosidl_typesupport_c"], *objects["python"]]
    _link(module / f"{package}_s__rosidl_typesupport_c.so", python, own)
    names = ["generator_c", *(one.removeprefix("rosidl_") for one in SUPPORTS)]
    # Loaded by name later, which finds what is loaded already.
    (module / "__init__.py").write_text(
        "import ctypes, pathlib\n"
        f"for name in {names!r}:\n"
        f"    library = f'lib{package}__rosidl_{{name}}.so'\n"
        "    ctypes.CDLL(str(pathlib.Path(__file__).with_name(library)), ctypes.RTLD_GLOBAL)\n"
    )
    return work / "python"


def _generate(package: str, names: list[str], work: Path) -> dict[str, list[Path]]:
    """Write the code of every generator; returns the sources by what they are linked into."""
    import rosidl_generator_c
    import rosidl_generator_py
    import rosidl_typesupport_c
    import rosidl_typesupport_fastrtps_c
    import rosidl_typesupport_introspection_c
    from rosidl_adapter.msg import convert_msg_to_idl
    from rosidl_generator_type_description import generate_type_hash

    for name in names:
        convert_msg_to_idl(work, package, Path("msg", f"{name}.msg"), work / "idl" / "msg")
    described = [f"msg/{name}.idl:{work / 'described' / 'msg' / name}.json" for name in names]

    def arguments(generator: str, output: Path, **more: list[str]) -> str:
        path = work / f"{generator}.json"
        document = {
            "package_name": package,
            "output_dir": str(output),
            "template_dir": str(PREFIX / "share" / generator / "resource"),
            "idl_tuples": [f"{work / 'idl'}:msg/{name}.idl" for name in names],
            "target_dependencies": [],
            "ros_interface_dependencies": [],
            "type_description_tuples": described,
            **more,
        }
        path.write_text(json.dumps(document))
        return str(path)

    paths = [f"{one}:{PREFIX / 'share' / one}" for one in NEEDED]
    generate_type_hash(
        arguments("rosidl_generator_type_description", work / "described", include_paths=paths)
    )
    include, inspected = work / "include" / package, work / "inspected" / package
    rosidl_generator_c.generate_c(arguments("rosidl_generator_c", include))
    rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c(
        arguments("rosidl_typesupport_fastrtps_c", include)
    )
    rosidl_typesupport_introspection_c.generate_c(
        arguments("rosidl_typesupport_introspection_c", inspected)
    )
    chosen = work / "chosen" / package
    rosidl_typesupport_c.generate_c(arguments("rosidl_typesupport_c", chosen), list(SUPPORTS))
    module = work / "python" / package
    rosidl_generator_py.generate_py(
        arguments("rosidl_generator_py", module), ["rosidl_typesupport_c"]
    )
    return {
        "c": sorted(include.rglob("*.c")),
        "rosidl_typesupport_fastrtps_c": sorted(include.rglob("*.cpp")),
        "rosidl_typesupport_introspection_c": sorted(inspected.rglob("*.c")),
        "rosidl_typesupport_c": sorted(chosen.rglob("*.cpp")),
        "python": sorted(module.rglob("*.c")),
    }


def _write_visibility(package: str, folder: Path) -> None:
    """Write the headers that CMake would configure."""
    for kind in ("rosidl_generator_c", "rosidl_typesupport_c", *SUPPORTS):
        lines = [
            f'#define {kind.upper()}_{role}_{package} __attribute__((visibility("default")))'
            for role in ("PUBLIC", "EXPORT", "IMPORT")
        ]
        path = folder / f"{kind}__visibility_control.h"
        path.write_text("\n".join(["#pragma once", *lines, ""]))


def _compile(files: list[Path], work: Path) -> list[Path]:
    includes = [
        work / "include",
        work / "inspected",
        Path(sysconfig.get_paths()["include"]),
        Path(np.get_include()),
        PREFIX / "include",
        *(path for path in (PREFIX / "include").iterdir() if path.is_dir()),
    ]
    flags = ["-O0", "-fPIC", "-w", "-c", *(f"-I{path}" for path in includes)]
    objects = []
    for number, path in enumerate(files):
        made = work / f"{path.parent.parent.name}_{number}_{path.name}.o"
        tool = ["g++", "-std=c++17"] if path.suffix == ".cpp" else ["gcc", "-D_GNU_SOURCE"]
        subprocess.run([*tool, *flags, str(path), "-o", str(made)], check=True)
        objects.append(made)
    return objects


def _link(path: Path, objects: list[Path], *more: str) -> None:
    libraries = [
        f"-l{one}__{part}"
        for one in NEEDED
        for part in ("rosidl_generator_c", "rosidl_generator_py", "rosidl_typesupport_c", *SUPPORTS)
    ]
    libraries += [f"-l{one}" for one in ("rosidl_runtime_c", "rosidl_typesupport_c", *SUPPORTS)]
    libraries += ["-lrosidl_typesupport_fastrtps_cpp", "-lrcutils", "-lfastcdr"]
    places = [f"-L{PREFIX / 'lib'}", f"-L{path.parent}"]
    found = [f"-Wl,-rpath,{PREFIX / 'lib'}", "-Wl,-rpath,$ORIGIN", f"-Wl,-soname,{path.name}"]
    words = ["g++", "-shared", "-o", str(path), *map(str, objects), *places, *found]
    subprocess.run([*words, *more, *libraries], check=True)
