# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""docs/interpretations.md, walked through: its switches act, and it lists every parameter."""

import functools
import re
from pathlib import Path

import pytest
from street import Street, follow

from vehicle_pf_tracker.parameters.table import from_mapping, specs, to_mapping
from vehicle_pf_tracker.trackers.parameters import ParticleParameters
from vehicle_pf_tracker.trackers.registry import find_variant

PAGE = (Path(__file__).parents[3] / "docs" / "interpretations.md").read_text(encoding="utf-8")
PAPERS = {
    "P1": ("apf",),
    "P2": ("mfpf", "sfpf_color", "sfpf_edge", "sfpf_texture"),
    "P3": ("conventional", "adaptive"),
}
VARIANTS = [(paper, name) for paper, names in PAPERS.items() for name in names]
ENTRY = re.compile(r"`([a-z_.]+): ([^`]+)`")
COMMON = {name for name in specs(ParticleParameters) if name != "num_particles"} | {"as_printed"}
"""Parameters of every tracker, which no paper speaks of."""
NOT_SET = {"num_particles"}
"""A size, not a rule: `as_printed` leaves it."""
BASIS = {
    "apf": {"occlusion.rule": "fixed"},
    # Without flatter weights every frame resamples.
    **{name: {"likelihood.sigma_v": 0.3} for name in PAPERS["P2"]},
}
"""Settings with which a run reaches all of its switches."""
SINKING = {12 + i: abs(i - 4) / 4 for i in range(9)} | {30 + i: abs(i - 16) / 16 for i in range(33)}
"""How much of the vehicle is seen, by time; all at others: once fast, once slowly."""


def rows(section, pattern):
    """Yield paper and `name: value` entries of each row of a section's table."""
    text = PAGE.split(section, 1)[1].split("\n## ", 1)[0]
    for line in text.splitlines():
        found = re.match(pattern, line)
        if found:
            paper = re.search(r"P[123]", found[0])
            yield (paper[0] if paper else "all"), line.strip().strip("|").rsplit("|", 1)[-1]


def entries(section, pattern=r"\| P[123] \|"):
    """Return {(variant, name): value} of a section, for the variants that have such a parameter."""
    found = {}
    for paper, cell in rows(section, pattern):
        for name, text in ENTRY.findall(cell):
            having = [v for v in PAPERS[paper] if name in specs(find_variant(v).parameters)]
            assert having, f"no variant of {paper} has {name}"
            for variant in having:
                found[variant, name] = specs(find_variant(variant).parameters)[name].parse(text)
    return found


SWITCHES = entries("| | where |", r"\| \d+ \| (P[123])")
DEFAULTS = entries("## Printed values that are the defaults too")
NOT_PRINTED = entries("## Values that are not printed")
EXTENSIONS = entries("## Parameters of our extensions")


def ids(found):
    return [f"{variant}-{name}" for variant, name in found]


def default(variant, name):
    return specs(find_variant(variant).parameters)[name].default


class Sinking(Street):
    """The street, on which the vehicle sinks out of sight and comes back."""

    def frame(self, time):
        frame, box = super().frame(time).copy(), self.box(time)
        first = int(box.y + SINKING.get(time, 1.0) * box.height)
        frame[first : int(box.y + box.height)] = self._road[first : int(box.y + box.height)]
        return frame


def run(variant, settings):
    """Estimates of a vehicle that is hidden for a while; `settings` are pairs."""
    values = {"seed": 3, "num_particles": 60, **BASIS.get(variant, {}), **dict(settings)}
    return _run_of(variant, from_mapping(find_variant(variant).parameters, values))


@functools.cache
def _run_of(variant, parameters):
    """Estimates by all parameters: a setting that is the default is no other run."""
    tracker = find_variant(variant).tracker(parameters)
    return [
        (e.position, e.regime, tuple(e.similarities.values()), e.effective_sample_size)
        for e in follow(tracker, Sinking(speed=2.0), range(60))
    ]


def other(variant, name, printed):
    """A value that is not the printed one: the default, or another where that is printed."""
    spec = specs(find_variant(variant).parameters)[name]
    if spec.default != printed:
        return spec.default
    choices = (True, False) if isinstance(printed, bool) else (*spec.choices, 10.0)
    return next(choice for choice in choices if choice != printed)


def test_the_table_is_read_whole():
    assert {number for number, _ in re.findall(r"^\| (\d+) \|(.*)$", PAGE, re.MULTILINE)} == {
        str(number) for number in range(1, 41)
    }
    assert len({name for _, name in SWITCHES}) >= 20
    for _, cell in rows("| | where |", r"\| \d+ \|"):
        assert ENTRY.search(cell) or "none: " in cell, cell


@pytest.mark.parametrize(("variant", "name"), SWITCHES, ids=ids(SWITCHES))
def test_a_switch_changes_the_run(variant, name):
    printed = SWITCHES[variant, name]
    without = run(variant, ((name, other(variant, name, printed)),))
    assert run(variant, ((name, printed),)) != without


@pytest.mark.parametrize(("variant", "name"), SWITCHES, ids=ids(SWITCHES))
def test_as_printed_sets_every_switch(variant, name):
    printed = SWITCHES[variant, name]
    parameters = find_variant(variant).parameters
    values = {"as_printed": True, name: other(variant, name, printed)}
    assert to_mapping(from_mapping(parameters, values).effective())[name] == printed


@pytest.mark.parametrize(("variant", "name"), DEFAULTS, ids=ids(DEFAULTS))
def test_printed_values_that_are_the_defaults_are_set_again(variant, name):
    printed = DEFAULTS[variant, name]
    spec = specs(find_variant(variant).parameters)[name]
    assert spec.default == printed
    if name in NOT_SET:
        return
    if isinstance(printed, bool):
        another = not printed
    elif spec.choices:
        another = next(choice for choice in spec.choices if choice != printed)
    else:
        another = type(printed)(printed + 1) if name != "occlusion.tau" else 0.5
    values = {"as_printed": True, name: another}
    effective = from_mapping(find_variant(variant).parameters, values).effective()
    assert to_mapping(effective)[name] == printed


@pytest.mark.parametrize(("variant", "name"), NOT_PRINTED, ids=ids(NOT_PRINTED))
def test_values_that_are_not_printed_are_listed_as_they_are(variant, name):
    assert default(variant, name) == NOT_PRINTED[variant, name]
    kept = from_mapping(find_variant(variant).parameters, {"as_printed": True}).effective()
    assert to_mapping(kept)[name] == NOT_PRINTED[variant, name]


@pytest.mark.parametrize(("variant", "name"), EXTENSIONS, ids=ids(EXTENSIONS))
def test_extensions_are_without_effect_as_printed(variant, name):
    spec = specs(find_variant(variant).parameters)[name]
    assert spec.default == EXTENSIONS[variant, name]
    changed = next(bound for bound in spec.bounds if bound != spec.default)
    printed = ("as_printed", True)
    assert run(variant, (printed, (name, changed))) == run(variant, (printed,))


@pytest.mark.parametrize(("paper", "variant"), VARIANTS)
def test_no_parameter_is_missing(paper, variant):
    listed = {
        name
        for found in (SWITCHES, DEFAULTS, NOT_PRINTED, EXTENSIONS)
        for owner, name in found
        if owner == variant
    }
    missing = set(specs(find_variant(variant).parameters)) - COMMON - listed
    assert not missing, f"{paper}: {sorted(missing)}"
