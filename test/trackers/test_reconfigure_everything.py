# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every parameter of every variant, changed while tracking, changes what is estimated.

The tables are walked, so a parameter that nothing reads cannot be added unnoticed.
"""

from __future__ import annotations

import copy
import functools

import pytest
from street import Street

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.parameters.table import ParameterSpec, from_mapping, specs, to_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.session import Session

PERIOD_NS = 40_000_000
CHANGE = 6
FRAMES = 40
HALT = 13
SINKING = {time: abs(index - 6) / 6 for index, time in enumerate(range(HALT, HALT + 13))}
"""How much of the vehicle is seen, by time; all at others."""

WITHOUT_EFFECT = {
    ("ms", "seed"): "mean shift draws no random numbers",
    ("fusion", "motion.camera"): "the camera of these images stands still",
    ("fusion", "motion.camera_velocity_sigma"): "the camera of these images stands still",
    ("fusion", "evidence.occluded_below"): "visibility is nearly certain in these images",
    ("fusion", "evidence.clear_above"): "visibility is nearly certain in these images",
    ("apf", "velocity.from_origin"): "says how a track begins, so it is obeyed by the next one",
}

KERNELS = "kernels"
"""Decides about the last digits at most; `test_kernel_parameter` has it."""


@functools.cache
def images():
    """A vehicle that drives, halts, sinks and comes back; one image missing; with stamps."""
    street, empty = Street(speed=3.0), Street(speed=3.0, hidden=(0, FRAMES))
    made = []
    for t in (*range(10), *range(11, FRAMES)):
        share, place = SINKING.get(t, 1.0), min(t, HALT)
        frame, box = empty.frame(place).copy(), street.box(place)
        rows = slice(0, int(box.y + share * box.height))
        frame[rows] = street.frame(place)[rows]
        made.append((frame, (t + 1) * PERIOD_NS))
    return made


def settings():
    box = Street().box(0)
    return SessionParameters(TargetParameters(box.x, box.y, box.width, box.height))


@functools.lru_cache(maxsize=1)
def _at_the_change(name, parameters):
    """A session that has had the images before the change; to be copied."""
    session = Session(VARIANTS[name], parameters, settings())
    for frame, stamp in images()[:CHANGE]:
        session.feed(frame, stamp)
    return session


def estimates(variant, parameters, changed):
    """Yield the scalars of the estimates after the change, but for the step's time."""
    session = copy.deepcopy(_at_the_change(variant.name, parameters))
    session.reconfigure(changed, settings())
    for frame, stamp in images()[CHANGE:]:
        told = session.feed(frame, stamp).scalars()
        yield {name: value for name, value in told.items() if name != "step_ms"}


@functools.cache
def unchanged(name, parameters):
    return list(estimates(VARIANTS[name], parameters, parameters))


def others(spec: ParameterSpec, value):
    """Values of this parameter, far from `value` and from each other."""
    if spec.kind is bool:
        return [not value]
    if spec.choices:
        return [word for word in spec.choices if word != value]
    wanted = [
        value * 0.9,
        value * 1.1,
        value * 2,
        value / 3,
        value / 30,
        value * 30,
        0.5,
        0.05,
        1,
        3,
        30,
    ]
    fitting = [spec.kind(one) for one in wanted if _fits(spec, spec.kind(one))]
    return [one for one in dict.fromkeys(fitting) if one != value]


def _fits(spec, value):
    try:
        spec.check(value)
    except InputError:
        return False
    return True


def bases(cls):
    """The defaults but for few particles, and those with one switch turned: some are read then."""
    few = from_mapping(cls, {"num_particles": 60} if "num_particles" in specs(cls) else {})
    yield few
    usual = to_mapping(few)
    switches = [
        spec
        for spec in specs(cls).values()
        if spec.name != KERNELS and (spec.kind is bool or spec.choices)
    ]
    for spec in switches:
        for other in others(spec, usual[spec.name]):
            yield from _made(cls, {spec.name: other}, few)


def _made(cls, values, base):
    """One, or none where the values do not fit together."""
    try:
        yield from_mapping(cls, values, base)
    except InputError:
        return


def is_obeyed(variant, spec) -> bool:
    for base in bases(variant.parameters):
        for value in others(spec, to_mapping(base)[spec.name]):
            for changed in _made(variant.parameters, {spec.name: value}, base):
                plain = unchanged(variant.name, base)
                told = estimates(variant, base, changed)
                if any(one != other for one, other in zip(plain, told, strict=True)):
                    return True
    return False


@pytest.mark.parametrize(
    "name",
    [pytest.param(one, marks=pytest.mark.slow if one == "fusion" else ()) for one in VARIANTS],
)
def test_every_parameter_is_obeyed_by_the_next_estimates(name):
    variant = VARIANTS[name]
    table = specs(variant.parameters)
    ignored = {
        (name, one)
        for one, spec in table.items()
        if one != KERNELS and not is_obeyed(variant, spec)
    }
    assert ignored == {one for one in WITHOUT_EFFECT if one[0] == name}
