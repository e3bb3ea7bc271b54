# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speed targets of the project, and their check against a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.bench.results import Results


@dataclass(frozen=True)
class Target:
    """A speed target.

    Attributes
    ----------
    case : str
        Name of the case that is judged.
    words : str
        Text of the target.
    value : callable
        Takes the measured value from the results; None where it was not measured.
    limit : float
        Least value where more is better, else the largest one.
    is_least : bool
        True if more is better.
    unit : str
        Unit behind the value, its space included.
    """

    case: str
    words: str
    value: Callable[[Results], float | None]
    limit: float
    is_least: bool
    unit: str

    def is_met(self, results: Results) -> bool | None:
        """Return whether `results` reach it; None where it was not measured."""
        value = self.value(results)
        if value is None:
            return None
        return value >= self.limit if self.is_least else value <= self.limit


def _faster(case: str, times: float) -> Target:
    def value(results: Results) -> float | None:
        found = results.case(case)
        return found.ratio if found else None

    return Target(case, f"at least {times:g} times faster", value, times, True, "x")


def _dearer(case: str, times: float) -> Target:
    def value(results: Results) -> float | None:
        found = results.case(case)
        return found.ours_ms / found.baseline_ms if found else None

    return Target(case, f"costs at most {times:g} times as much", value, times, False, "x")


def _takes(case: str, milliseconds: float) -> Target:
    def value(results: Results) -> float | None:
        found = results.case(case)
        return found.ours_ms if found else None

    return Target(case, f"takes at most {milliseconds:g} ms", value, milliseconds, False, " ms")


def _loses_nothing(case: str) -> Target:
    def value(results: Results) -> float | None:
        return next(
            (float(delivery.lost) for delivery in results.deliveries if delivery.name == case), None
        )

    return Target(case, "loses no image", value, 0.0, False, " lost")


# As ratios to CSRT in the same run: they carry over to other machines, and times do not.
STEPS = {
    "pf": 80,
    "apf": 40,
    "adaptive": 40,
    "sapf": 40,
    "ms": 60,
    "hpfms": 20,
    "pfcl": 15,
    "mfpf": 25,
}
"""Target ratio of CSRT's step to a variant's full step."""

SPEED_TARGETS = (
    _faster("kernel/joint512/41x31/vga/n200", 25),
    _faster("kernel/joint512/41x31/vga/n1000", 80),
    _faster("kernel/joint512/41x31/vga/n5000", 200),
    _faster("kernel-opencv/joint512/41x31/vga/n200", 4),
    _faster("kernel-opencv/joint512/41x31/vga/n1000", 10),
    _dearer("kernel/joint512/41x31/1080p-over-vga/n200", 1.2),
    _faster("kernel/three_features/41x31/vga/n200", 80),
    *(_faster(f"step/{variant}/csrt", times) for variant, times in STEPS.items()),
    _dearer("node/apf/without_step", 1.15),
    _dearer("node/apf/with_step", 1.4),
    _loses_nothing("fleet/apf/8x640x480"),
    _takes("startup/apf/warm", 1500),
)
