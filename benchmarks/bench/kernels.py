# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarity of many windows against one crop and one histogram per particle, one thread each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from benchmarks.bench import naive
from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.interleaving import Work, compare
from benchmarks.bench.material import clouds, drive, enlarged
from benchmarks.bench.routes import Route, routes, three_references
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.window import Positions, Window

COUNTS = (50, 200, 1000, 5000)
"""Particles: 200 are the default."""
WINDOWS = {"41x31": Window(20, 15), "81x61": Window(40, 30)}
"""Windows by their sizes in px: the default, and one of four times as many pixels."""
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
    for route in routes():
        for name, make in contests(route).items():
            if wanted(name):
                yield compare(name, *make(), effort.case_seconds)


def contests(route: Route) -> dict[str, Callable[[], tuple[Work, Work]]]:
    """Give what makes the two pieces of work of each case, by its name."""
    made: dict[str, Callable[[], tuple[Work, Work]]] = {
        f"{route.name}/joint512/{window}/{size}/n{count}": _joint(route, size, window, count)
        for size in ("vga", "1080p")
        for window in WINDOWS
        for count in COUNTS
    }
    made[f"{route.name}/joint512/41x31/1080p-over-vga/n200"] = _sizes(route)
    made[f"{route.name}/three_features/41x31/vga/n200"] = _three(route)
    return made


def _joint(route: Route, size: str, window: str, count: int) -> Callable[[], tuple[Work, Work]]:
    def make() -> tuple[Work, Work]:
        inputs = _inputs(size, window, count)
        # Both compare with one histogram, that of the naive way.
        histogram = naive.joint_histogram(inputs.frames[0], *_target(), inputs.window)
        reference = Reference(histogram)
        return (
            lambda number: route.joint(*inputs.at(number), reference),
            lambda number: naive.joint_similarity(*inputs.at(number), histogram),
        )

    return make


def _sizes(route: Route) -> Callable[[], tuple[Work, Work]]:
    def make() -> tuple[Work, Work]:
        # One reference for both sizes: windows and particles are the same, only the image grows.
        large, small = (_inputs(size, "41x31", 200) for size in ("1080p", "vga"))
        reference = Reference(naive.joint_histogram(small.frames[0], *_target(), small.window))
        return (
            lambda number: route.joint(*large.at(number), reference),
            lambda number: route.joint(*small.at(number), reference),
        )

    return make


def _three(route: Route) -> Callable[[], tuple[Work, Work]]:
    def make() -> tuple[Work, Work]:
        inputs = _inputs("vga", "41x31", 200)
        histograms = naive.three_histograms(inputs.frames[0], *_target(), inputs.window)
        references = three_references(histograms)
        return (
            lambda number: route.three(*inputs.at(number), references),
            lambda number: naive.three_similarities(*inputs.at(number), histograms),
        )

    return make


def _inputs(size: str, window: str, count: int) -> _Inputs:
    first = len(drive().frames) // 2  # the whole cloud is far from the border there
    # The vehicle in each image differs by what it drives; the reference is that of the first.
    frames = [enlarged(frame, size) for frame in drive().frames[first : first + _VARIETY]]
    centre = drive().boxes[first].centre
    return _Inputs(frames, clouds(centre, count, _VARIETY), WINDOWS[window])


def _target() -> tuple[float, float]:
    return drive().boxes[len(drive().boxes) // 2].centre
