# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`docs/performance.md` and its figures from the results of a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from benchmarks.bench.case import Case
from benchmarks.bench.figures import steps_figure
from benchmarks.bench.results import Results
from benchmarks.bench.slower_steps import SLOWER_RATIO, last_ratios, slower_steps
from benchmarks.bench.targets import SPEED_TARGETS, Target
from benchmarks.bench.turns import TURN_FRAMES
from laboratory.figure_files import save

PAGE = "performance.md"
"""Name of the page in its folder."""
IMAGES = "images/performance"
"""Folder of its figures, beside it."""
TARGETS_TABLE = "targets.md"
"""Table of the speed targets, written beside the results."""
_HEAD = """# Performance

CPU time of one thread (of the whole process for nodes), from one run in which our code and the
baseline took turns. Times are medians. A ratio is the baseline's median over ours, ± half its
interquartile range; above 1 ours is cheaper. Ratios carry over to other machines, times do not.
`make bench` writes this page; `bench.json` has all cases, `targets.md` the speed targets.
"""
_STEPS = f"""## One frame's step
One vehicle of 40x30 px drives through 640x480 images. Each tracker follows it through {TURN_FRAMES}
frames at full speed, then the next one takes its turn. All run with their defaults, OpenCV's
trackers in a process of their own with one thread. [fusion.md](fusion.md) has the cost of `fusion`
on real video.

![Times faster than CSRT, by variant]({IMAGES}/steps.svg)
"""
_MEMORY_PARTS = """
`python -m benchmarks.memory_parts` prints what a node's memory is made of. Compiled kernels are
linked by LLVM, without numba; a start that has to compile them imports numba, which keeps another
100 MB until the next start. Once they are linked, a node gives the pages of LLVM's library back,
some 45 MB. All nodes of a machine share them, so that eight nodes save little more than one does.
Half of what is left is code of libraries, shared as well.
"""
_BANDWIDTH = """## Distance from memory bandwidth
A kernel has to fetch the part of the image that its windows cover; no code is faster than memory
gives those bytes. The share is that of the time in which they are read once, and nothing else is
done. What is left is work in the caches: each pixel is counted in hundreds of windows.
"""
_COSTS = """## Cost of more particles, larger windows and images, more trackers
The default is 200 particles, a window of 41x31 px, 640x480 images and one tracker. Ratio to it,
and the time of one tracker's step.
"""
_NODES = """## The node
The baseline is a node that takes the image and publishes a point, with rclpy's own executor.
Images of 640x480 come at 30 Hz from another process. `without_step` leaves out the tracker's steps,
`all_heard` has subscribers to every output. Caches are cold between two images, so a step takes
longer than above. Start-up lasts until the node is ready. Its baselines are the node above
(`warm`), a start with the OpenCV kernels (`numba`), and a warm start (`cold`: nothing compiled).
Of a cold start of `apf` two seconds load numba and the package, the rest compiles its three
kernels: three quarters of that the one that compares windows of joint colours. About a third of
compiling is LLVM's work, the rest numba's in Python: machine code is made of whole kernels, and not
of each of their parts. Later starts link what was compiled, and load no numba.
`python -m benchmarks.first_answer` prints the seconds from a start to the first answered image.
"""


def write_targets(results: Results, folder: Path) -> None:
    """Write the table of the speed targets into `folder`."""
    (folder / TARGETS_TABLE).write_text(targets_table(results, SPEED_TARGETS), encoding="utf-8")


def write(results: Results, folder: Path) -> str:
    """Write the page and its figures below `folder`.

    Returns
    -------
    str
        Table of the steps that are dearer than on the page that is replaced; it is on the new one.
    """
    # Read before it is replaced.
    last = (folder / PAGE).read_text(encoding="utf-8") if (folder / PAGE).exists() else ""
    images = folder / IMAGES
    images.mkdir(parents=True, exist_ok=True)
    save(steps_figure(results), images / "steps.svg")
    (folder / PAGE).write_text(page(results, last), encoding="utf-8")
    return _dearer(results, last)


def page(results: Results, last: str = "") -> str:
    """Write the page; `last` is the text of the one that it replaces."""
    parts = [
        _HEAD,
        _environment(results),
        _targets(results, SPEED_TARGETS),
        _STEPS,
        _steps(results),
        _dearer(results, last),
        _BANDWIDTH,
        _bandwidth(results),
        _COSTS,
        _pivot(_costs(results), "change"),
        _NODES,
        _cases(results, "node/", "startup/"),
        _deliveries(results),
        _memory(results),
    ]
    return "\n".join(part for part in parts if part)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table, its first column to the left and the others to the right."""
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _environment(results: Results) -> str:
    # A copy: the results keep the date that is taken out here.
    machine = dict(results.environment)
    made = machine.pop("made", "unknown date")
    facts = ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in machine.items())
    commands = "".join(f"    {command}\n" for command in results.commands)
    return f"Measured {made}: {facts}.\n\n{commands}"


def _targets(results: Results, targets: Sequence[Target]) -> str:
    """Count the targets that are met, and name the others."""
    met = [target.is_met(results) for target in targets]
    lines = [f"{sum(one is True for one in met)} of {len(met)} speed targets are met."]
    for words, verdict in (("Missed", False), ("Not measured", None)):
        named = [f"`{t.case}`" for t, one in zip(targets, met, strict=True) if one is verdict]
        lines += [f"{words}: {', '.join(named)}."] if named else []
    return "\n".join(lines) + "\n"


def targets_table(results: Results, targets: Iterable[Target]) -> str:
    """Write a table of the targets, with what was measured."""
    verdicts = {True: "met", False: "**missed**", None: "not measured"}
    rows = []
    for target in targets:
        value = target.value(results)
        measured = "" if value is None else f"{value:.4g}{target.unit}"
        verdict = verdicts[target.is_met(results)]
        rows.append((f"`{target.case}`", target.words, measured, verdict))
    return table(("case", "target", "measured", "verdict"), rows)


_Cells: TypeAlias = Mapping[str, Mapping[str, Case]]
"""Cases by the row and by the column of a table."""


def _costs(results: Results) -> _Cells:
    """Cases by what is changed and by variant."""
    cells: dict[str, dict[str, Case]] = {}
    for case in results.cases:
        if case.name.startswith("cost/"):
            _, changed, variant, value = case.name.split("/")
            # Particles are `n200` in cases of kernels, too; a table shows the number.
            value = value.removeprefix("n") if changed == "particles" else value
            cells.setdefault(f"{changed}: {value}", {})[f"`{variant}`"] = case
    return cells


def _pivot(cells: _Cells, corner: str) -> str:
    # Columns in the order in which they first come up, each once.
    columns = list(dict.fromkeys(name for row in cells.values() for name in row))
    rows = [
        # A case that was not measured leaves its cell empty.
        (name, *(_ratio_and_time(row[column]) if column in row else "" for column in columns))
        for name, row in cells.items()
    ]
    return table((corner, *columns), rows)


def _ratio_and_time(case: Case) -> str:
    return f"{_ratio(case)}; {_digits(case.ours_ms)} ms"


def _cases(results: Results, *prefixes: str) -> str:
    rows = [_row(case) for case in results.cases if case.name.startswith(prefixes)]
    return table(("case", "ours, ms", "baseline, ms", "ratio"), rows)


def _row(case: Case) -> tuple[str, ...]:
    return f"`{case.name}`", _digits(case.ours_ms), _digits(case.baseline_ms), _ratio(case)


def _digits(milliseconds: float) -> str:
    """Write four digits, and no power of ten."""
    return f"{float(f'{milliseconds:.4g}'):.10g}"


def _ratio(case: Case) -> str:
    return f"{case.ratio:.3g} ± {case.spread / 2:.2g}"


def _steps(results: Results) -> str:
    found = {case.name: case for case in results.cases if case.name.startswith("step/")}
    baselines = list(dict.fromkeys(name.split("/")[2] for name in found))
    rows = []
    for variant in dict.fromkeys(name.split("/")[1] for name in found):
        cases = [found.get(f"step/{variant}/{baseline}") for baseline in baselines]
        # The same step was timed once beside all baselines.
        own = next(case.ours_ms for case in cases if case is not None)
        ratios = [_ratio(case) if case else "" for case in cases]
        share = f"{100 * results.on_target.get(variant, 0):.0f} %"
        rows.append((f"`{variant}`", f"{own:.4g}", *ratios, share))
    times = {case.name.split("/")[2]: case.baseline_ms for case in found.values()}
    for baseline in baselines:
        share = f"{100 * results.on_target.get(baseline, 0):.0f} %"
        rows.append((f"{baseline} itself", f"{times[baseline]:.4g}", *[""] * len(baselines), share))
    head = ("step", "ms", *(f"over {baseline}" for baseline in baselines), "on the vehicle")
    return table(head, rows)


def _dearer(results: Results, last: str) -> str:
    """Write the steps that became dearer than on the last page, or that none did."""
    head = "## Dearer than the last page\n"
    # A page without the table of steps is none to compare with.
    if not last_ratios(last):
        return head + "There was no page to compare with.\n"
    factors = slower_steps(results, last)
    if not factors:
        return (
            head
            + f"No step takes more than {SLOWER_RATIO:g} times as long, beside the baselines.\n"
        )
    rows = [(f"`{variant}`", f"{factor:.2f}") for variant, factor in factors.items()]
    return head + table(("step", "times as long"), rows)


def _bandwidth(results: Results) -> str:
    rows = [
        (
            f"`{case.name.removeprefix('bandwidth/')}`",
            _digits(case.baseline_ms),
            _digits(case.ours_ms),
            f"{100 * case.ratio:.1f} %",
        )
        for case in results.cases
        if case.name.startswith("bandwidth/")
    ]
    return table(("kernel", "reading, ms", "kernel, ms", "share"), rows)


def _deliveries(results: Results) -> str:
    lines = [
        f"- `{delivery.name}`: {delivery.sent} images at {delivery.rate_hz:g} Hz each, "
        f"{delivery.lost} lost, {delivery.cpu_ms:.3g} ms of CPU per image, "
        f"{delivery.memory_mb:.0f} MB in all."
        for delivery in results.deliveries
    ]
    head = (
        "Several nodes, each with a camera, in processes of their own and in one (`container`):\n"
    )
    return "\n".join([head, *lines]) + "\n"


def _memory(results: Results) -> str:
    rows = [(f"`{m.name}`", f"{m.ours_mb:.1f}", f"{m.baseline_mb:.1f}") for m in results.memory]
    words = (
        "Resident memory, against one tracker in the process, and against the baseline node:\n\n"
    )
    return words + table(("memory", "ours, MB", "baseline, MB"), rows) + _MEMORY_PARTS
