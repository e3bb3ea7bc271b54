# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cost of a step by particles, window, image, and trackers in one process."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.material import FRAME_SIZES
from benchmarks.bench.turns import Follower, Own, follow

BENCHED_VARIANTS = ("apf", "mfpf")
"""A variant of one feature, and one of three."""
# From a quarter of the default to 25 times as much: a cost per particle or per pixel shows in the
# larger steps, and a cost per step in the smallest.
PARTICLES = (50, 200, 1000, 5000)
WINDOWS = ((21, 15), (41, 31), (81, 61), (161, 121))
TRACKERS = (1, 4, 16, 64)
BASES = {"particles": "n200", "window": "41x31", "image": "vga", "trackers": "1"}
"""Defaults, which the others are compared with."""


def measure(wanted: Callable[[str], bool], effort: Effort) -> Iterator[Case]:
    """Measure ``cost/WHAT/VARIANT/SETTING``; the baseline is the same variant with `BASES`."""
    for variant in BENCHED_VARIANTS:
        for what, settings in _settings(variant).items():
            yield from _compared(f"cost/{what}/{variant}", settings, BASES[what], wanted, effort)


def _settings(variant: str) -> dict[str, dict[str, Follower]]:
    return {
        "particles": {f"n{count}": Own(variant, {"num_particles": count}) for count in PARTICLES},
        "window": {
            f"{width}x{height}": Own(variant, {"window.width": width, "window.height": height})
            for width, height in WINDOWS
        },
        "image": {size: Own(variant, size=size) for size in FRAME_SIZES},
        "trackers": {str(count): Own(variant, count=count) for count in TRACKERS},
    }


def _compared(
    prefix: str,
    settings: dict[str, Follower],
    base: str,
    wanted: Callable[[str], bool],
    effort: Effort,
) -> Iterator[Case]:
    chosen = [name for name in settings if name != base and wanted(f"{prefix}/{name}")]
    if not chosen:
        return
    # The default runs beside the chosen ones in turns, and only where there are any.
    followers = {name: settings[name] for name in (base, *chosen)}
    # One pass: each setting runs through the whole drive.
    times, _ = follow(followers, range(1), effort.frames)
    for name in chosen:
        yield Case.of(f"{prefix}/{name}", times[name], times[base])
