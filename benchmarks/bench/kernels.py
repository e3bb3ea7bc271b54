"""Similarity of many windows against one crop and one histogram per particle."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from benchmarks.bench import naive
from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.interleaving import compare
from benchmarks.bench.material import clouds, drive, enlarged
from benchmarks.bench.routes import Route, routes
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.window import Positions, Window

COUNTS = (50, 200, 1000, 5000)
WINDOWS = {"41x31": Window(20, 15), "81x61": Window(40, 30)}
_VARIETY = 8
"""Frames and clouds that the calls take in turns."""


class _Inputs(NamedTuple):
    frames: list[Frame]
    clouds: list[Positions]
    window: Window

    def at(self, number: int) -> tuple[Frame, Positions, Window]:
        index = number % len(self.frames)
        return self.frames[index], self.clouds[index], self.window


def measure(wanted: Callable[[str], bool], effort: Effort) -> Iterator[Case]:
    """Measure features, windows, image sizes, numbers of particles and routes."""
    for kind, route in routes().items():
        for size in ("vga", "1080p"):
            for window in WINDOWS:
                for count in COUNTS:
                    name = f"{kind}/joint512/{window}/{size}/n{count}"
                    if wanted(name):
                        yield _joint(name, route, _inputs(size, window, count), effort)
        name = f"{kind}/joint512/41x31/1080p/n200-over-vga"
        if wanted(name):
            yield _sizes(name, route, effort)
        name = f"{kind}/three_features/41x31/vga/n200"
        if wanted(name):
            yield _three(name, route, _inputs("vga", "41x31", 200), effort)


def _inputs(size: str, window: str, count: int) -> _Inputs:
    first = len(drive().frames) // 2  # the whole cloud is far from the border there
    frames = [enlarged(frame, size) for frame in drive().frames[first : first + _VARIETY]]
    centre = drive().boxes[first].centre
    return _Inputs(frames, clouds(centre, count, _VARIETY), WINDOWS[window])


def _joint(name: str, route: Route, inputs: _Inputs, effort: Effort) -> Case:
    reference = naive.joint_histogram(inputs.frames[0], *_target(), inputs.window)
    return compare(
        name,
        lambda number: route.joint(*inputs.at(number), reference),
        lambda number: naive.joint_similarity(*inputs.at(number), reference),
        effort.case_seconds,
    )


def _sizes(name: str, route: Route, effort: Effort) -> Case:
    large, small = (_inputs(size, "41x31", 200) for size in ("1080p", "vga"))
    reference = naive.joint_histogram(small.frames[0], *_target(), small.window)
    return compare(
        name,
        lambda number: route.joint(*large.at(number), reference),
        lambda number: route.joint(*small.at(number), reference),
        effort.case_seconds,
    )


def _three(name: str, route: Route, inputs: _Inputs, effort: Effort) -> Case:
    references = naive.three_histograms(inputs.frames[0], *_target(), inputs.window)
    return compare(
        name,
        lambda number: route.three(*inputs.at(number), references),
        lambda number: naive.three_similarities(*inputs.at(number), references),
        effort.case_seconds,
    )


def _target() -> tuple[float, float]:
    return drive().boxes[len(drive().boxes) // 2].centre
