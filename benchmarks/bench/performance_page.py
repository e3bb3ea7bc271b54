# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""`docs/performance.md` and its figures from the results of a run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from benchmarks.bench.case import Case
from benchmarks.bench.figures import kernels_figure, steps_figure
from benchmarks.bench.results import Results
from benchmarks.bench.targets import TARGETS, Target
from benchmarks.bench.turns import BLOCK
from vehicle_pf_tracker.evaluation.plots import save

PAGE = "performance.md"
IMAGES = "images/performance"
_HEAD = """# Performance

Made from `results/bench/bench.json` by `make bench`; nothing here is written by hand. Every number
is from one run, in which ours and what it is compared with took turns, and is CPU time of the one
thread that works (of the whole process for nodes). Times are medians; a ratio is the baseline's
median over ours, so that above 1 ours is the cheaper one, and behind ± stands half its
interquartile range. Absolute times are those of the machine below; the ratios are what to trust.
"""
_KERNELS = """## Windows measured at once

The naive baseline takes one crop, one `cv2.calcHist` of 8x8x8 bins (or P2's three features in
OpenCV and numpy) and one coefficient for each particle. The particles are spread around the vehicle
by 8 px, and every call sees another frame and another cloud. A turn lasts 5 ms at least, so that
both work from warm caches; between the images of a node they are colder (see there). `kernel` is
the route with numba, `kernel-opencv` the one without; `1080p-over-vga` compares the two image sizes
with each other, and `map512` the similarities of all pixels of an image by the two routes.
"""
_STEPS = f"""## A frame's whole step

Against OpenCV's trackers on one vehicle of 40x30 px that drives through 640x480 images. Each in its
turn follows it through {BLOCK} frames at full speed, then the next one does. The baselines run in a
process of their own with one thread; the transfer of the frame does not count. Defaults throughout.
What `fusion` costs on real sequences, whole ones and in 4K, is in [fusion.md](fusion.md), Cost.
"""
_COSTS = """## What more costs

The same variant with more particles, another window, a larger image, or more trackers in the
process (time of one of them), against itself as it is by default: 200 particles, 41x31 px,
640x480, one.
"""
_NODES = """## The node

The floor is a node that takes the image and publishes a point, and does nothing else, with rclpy's
own executor, the same subscription, and the allocator settings of the launch files. Images of
640x480 come at 30 Hz from another process, which listens to `position`. `without_step` is the CPU
of the whole process less that of the tracker's steps; for `all_heard` somebody listens to `mode`,
`box` and `velocity` too, which are not made otherwise. With a pause between two images the caches
are cold, so that the step takes longer here than in the table above. Start-up is the CPU of the
process until it says that it is ready: `warm` is compared with the floor's, `numba` with a start
with the OpenCV kernels, and `cold` (nothing compiled before) with `warm`.
"""


def write(results: Results, folder: Path) -> None:
    """Write the page and its figures below `folder`."""
    images = folder / IMAGES
    images.mkdir(parents=True, exist_ok=True)
    save(kernels_figure(results), images / "kernels.svg")
    save(steps_figure(results), images / "steps.svg")
    (folder / PAGE).write_text(page(results), encoding="utf-8")


def page(results: Results) -> str:
    """Write the page."""
    parts = [
        _HEAD,
        _environment(results),
        "## Targets and results\n\n" + _targets(results, TARGETS),
        _KERNELS,
        f"![Times faster than naive, by particles]({IMAGES}/kernels.svg)\n",
        _cases(results, "kernel"),
        _STEPS,
        f"![Times faster than CSRT, by variant]({IMAGES}/steps.svg)\n",
        _steps(results),
        _COSTS,
        _cases(results, "cost/"),
        _NODES,
        _cases(results, "node/", "startup/"),
        _numba_share(results),
        _deliveries(results),
        _memory(results),
    ]
    return "\n".join(parts)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table, its first column to the left and the others to the right."""
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _environment(results: Results) -> str:
    rows = [(name.replace("_", " "), str(value)) for name, value in results.environment.items()]
    commands = "".join(f"    {command}\n" for command in results.commands)
    return f"{table(('environment', ''), rows)}\nMade by\n\n{commands}"


def _targets(results: Results, targets: Iterable[Target]) -> str:
    verdicts = {True: "met", False: "**missed**", None: "not measured"}
    rows = []
    for target in targets:
        value = target.value(results)
        told = "" if value is None else f"{value:.4g}{target.unit}"
        rows.append((f"`{target.case}`", target.words, told, verdicts[target.is_met(results)]))
    return table(("case", "target", "measured", "verdict"), rows)


def _cases(results: Results, *prefixes: str) -> str:
    rows = [_row(case) for case in results.cases if case.name.startswith(prefixes)]
    return table(("case", "ours, ms", "baseline, ms", "ratio"), rows)


def _row(case: Case) -> tuple[str, ...]:
    ratio = f"{case.ratio:.3g} ± {case.spread / 2:.2g}"
    return f"`{case.name}`", f"{case.ours_ms:.4g}", f"{case.baseline_ms:.4g}", ratio


def _steps(results: Results) -> str:
    found = {case.name: case for case in results.cases if case.name.startswith("step/")}
    baselines = list(dict.fromkeys(name.split("/")[2] for name in found))
    rows = []
    for variant in dict.fromkeys(name.split("/")[1] for name in found):
        cases = [found.get(f"step/{variant}/{baseline}") for baseline in baselines]
        own = next(case.ours_ms for case in cases if case is not None)
        ratios = [_row(case)[3] if case else "" for case in cases]
        share = f"{100 * results.on_target.get(variant, 0):.0f} %"
        rows.append((f"`{variant}`", f"{own:.4g}", *ratios, share))
    times = {case.name.split("/")[2]: case.baseline_ms for case in found.values()}
    for baseline in baselines:
        share = f"{100 * results.on_target.get(baseline, 0):.0f} %"
        rows.append((f"{baseline} itself", f"{times[baseline]:.4g}", *[""] * len(baselines), share))
    head = ("step", "ms", *(f"over {baseline}" for baseline in baselines), "on the vehicle")
    return table(head, rows)


def _numba_share(results: Results) -> str:
    case = results.case("startup/apf/numba")
    if case is None:
        return ""
    share = case.ours_ms - case.baseline_ms
    return f"Of a warm start's {case.ours_ms:.0f} ms, numba and its kernels take {share:.0f} ms.\n"


def _deliveries(results: Results) -> str:
    rows = [
        (f"`{one.name}`", f"{one.rate_hz:g}", str(one.sent), str(one.lost), f"{one.cpu_ms:.3g}")
        for one in results.deliveries
    ]
    words = "Nodes at once, each with a camera of its own, reliable with a depth of 10:\n\n"
    return words + table(("nodes", "Hz each", "images", "lost", "CPU per image, ms"), rows)


def _memory(results: Results) -> str:
    rows = [(f"`{m.name}`", f"{m.ours_mb:.1f}", f"{m.baseline_mb:.1f}") for m in results.memory]
    words = (
        "Resident memory, shared libraries included: a process with many trackers against the "
        "same with one,\nand the node against the floor:\n\n"
    )
    return words + table(("memory", "ours, MB", "baseline, MB"), rows)
