# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Program of `test_live_switches.py`: turns every switch of one variant while it tracks.

Memory that is overwritten ends a process, so this one has nothing else to do. Its words are the
variant, and the numbers of bits of its histograms. Its last line is ``done`` and the number of
switches that were turned.
"""

from __future__ import annotations

import itertools
import sys
from importlib.util import find_spec

import numpy as np
from street import HEIGHT, WIDTH, Street

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import from_mapping, specs, to_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS

STREET = Street(speed=2.0)
BITS = "histogram_bits"
LEARNT = ("reference", "references", "first_histogram", "first_histograms")
"""Attributes in which variants keep what they have learnt of the target."""


def cases(table, all_bits):
    """Each switch from each value to each other one, at each number of bits."""
    kernels = ("opencv", "numba") if find_spec("numba") else ("opencv",)
    all_bits = all_bits if BITS in table else [None]
    switches = [spec for spec in table.values() if spec.kind is bool or spec.choices]
    for spec, used in itertools.product(switches, kernels):
        values = [False, True] if spec.kind is bool else list(spec.choices)
        if spec.name == "kernels":
            values = ["auto", *kernels]
        for (before, after), bits in itertools.product(itertools.permutations(values, 2), all_bits):
            common = {"kernels": used} if bits is None else {"kernels": used, BITS: bits}
            if "num_particles" in table:
                common["num_particles"] = 20
            yield {**common, spec.name: before}, {**common, spec.name: after}


def random_changes(table, count):
    """Settings with two parameters each drawn from their bounds, or from nothing but them."""
    rng = np.random.default_rng(1)
    for _ in range(count):
        values = {}
        for name in rng.choice([name for name in table if name != "kernels"], 2):
            spec = table[name]
            if spec.kind is bool or spec.choices:
                choices = [False, True] if spec.kind is bool else list(spec.choices)
                values[name] = choices[rng.integers(len(choices))]
            else:
                low, high = max(spec.bounds[0], -1e3), min(spec.bounds[1], 300)
                drawn = rng.choice([low, high, rng.uniform(low, high)])
                values[name] = spec.kind(drawn)
        yield values


def learnt(tracker):
    """Shape of everything in `LEARNT`."""
    for name in LEARNT:
        kept = getattr(tracker, name, [])
        for histogram in kept if isinstance(kept, list) else [kept]:
            yield name, np.shape(getattr(histogram, "histogram", histogram))


def numbers(estimate):
    scalars = {k: v for k, v in estimate.scalars().items() if k != "step_ms"}
    return scalars, estimate.particles.tobytes(), estimate.weights.tobytes()


def is_sound(estimate):
    particles = estimate.particles
    return (
        np.isfinite(particles).all()
        and np.isfinite(estimate.weights).all()
        and particles.min() >= 0
        and (particles <= [WIDTH, HEIGHT]).all()
    )


def main(name, *all_bits):
    variant = VARIANTS[name]
    table = specs(variant.parameters)

    def made(values):
        return from_mapping(variant.parameters, values)

    def started(values, time):
        tracker = variant.tracker(made(values))
        return tracker, tracker.start(STREET.frame(time), STREET.box(time))

    turned = list(cases(table, all_bits))
    for before, after in turned:
        # A switch between the first two frames is a start with it, to the last bit ...
        fresh, _ = started(after, 0)
        switched, _ = started(before, 0)
        switched.reconfigure(made(after))
        for time in (1, 2, 3):
            frame = STREET.frame(time)
            expected = numbers(fresh.step(frame))
            assert numbers(switched.step(frame)) == expected, (before, after)
        # ... a later one learns the target as a start does, and tracks on ...
        switched.reconfigure(made(before))
        assert is_sound(switched.step(STREET.frame(4))), (before, after)
        switched.reconfigure(made(after))
        assert list(learnt(switched)) == list(learnt(fresh)), (before, after)
        assert is_sound(switched.step(STREET.frame(5))), (before, after)
        # ... and leaves nothing behind that a start from there on would not have.
        again = switched.start(STREET.frame(6), STREET.box(6))
        fresh, first = started(after, 6)
        assert numbers(again) == numbers(first), (before, after)
        assert numbers(switched.step(STREET.frame(7))) == numbers(fresh.step(STREET.frame(7)))

    tracker, _ = started({}, 0)
    for values in random_changes(table, 60):
        try:
            parameters = made(values)
        except InputError:  # two thresholds that have to be in order
            continue
        tracker.reconfigure(parameters)
        assert to_mapping(tracker.parameters) == to_mapping(parameters)
        assert is_sound(tracker.step(STREET.frame(3))), values
    print("done", len(turned))


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
