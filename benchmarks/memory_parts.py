# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of a node's resident memory: `python -m benchmarks.memory_parts`.

One process loads what a node loads, in the same order, and prints how its memory grows. Pages that
belong to the process alone are told from those of files, which all nodes of a machine share.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple


class Memory(NamedTuple):
    """Resident memory of this process in MB: all of it, and what no other process can share."""

    resident: float
    own: float


def main() -> None:
    """Print the table."""
    print("| loaded | resident, MB | of that its own, MB |\n| --- | ---: | ---: |")
    for line in rows(parts()):
        print("|", " | ".join(line), "|")


def parts() -> Sequence[tuple[str, Callable[[], object]]]:
    """Return what a node of `apf` loads, in its order; what is not installed is left out."""
    modules = ("numpy", "cv2", "rclpy.node", "llvmlite.binding")
    loads = [(f"`{name}`", importer(name)) for name in modules if has(name)]
    last = [("kernels and step of `apf`", step), ("LLVM's pages, given back", give_back)]
    return [*loads, *last]


def step() -> None:
    """Load or compile the kernels of `apf`, and step it."""
    # Not at the top: what these import belongs to this row.
    from vehicle_pf_tracker.trackers.registry import VARIANTS  # noqa: PLC0415
    from vehicle_pf_tracker.trackers.rehearsal import rehearse  # noqa: PLC0415

    variant = VARIANTS["apf"]
    rehearse(variant, variant.parameters())


def give_back() -> None:
    """Give back what a node gives back once its kernels are linked."""
    from vehicle_pf_tracker.ros.library_memory import give_back_library  # noqa: PLC0415

    give_back_library("libllvmlite")


def has(name: str) -> bool:
    """Test whether a module's distribution is installed, without importing what it needs."""
    return importlib.util.find_spec(name.partition(".")[0]) is not None


def importer(name: str) -> Callable[[], object]:
    """Make a function that imports a module."""
    return lambda: importlib.import_module(name)


def rows(loads: Sequence[tuple[str, Callable[[], object]]]) -> list[tuple[str, str, str]]:
    """Run each load, and tell by how much memory grows; the sum comes last."""
    before = first = memory()
    lines = [("at the start", f"{first.resident:.0f}", f"{first.own:.0f}")]
    for name, load in loads:
        load()
        after = memory()
        grown = after.resident - before.resident
        lines.append((name, f"{grown:+.0f}", f"{after.own - before.own:+.0f}"))
        before = after
    return [*lines, ("all", f"{before.resident:.0f}", f"{before.own:.0f}")]


def memory() -> Memory:
    """Measure this process."""
    fields = {}
    for line in Path("/proc/self/smaps_rollup").read_text().splitlines()[1:]:
        name, kilobytes, *_ = line.split()
        fields[name] = int(kilobytes) * 1024 / 1e6
    return Memory(fields["Rss:"], fields["Anonymous:"])


if __name__ == "__main__":
    main()
