# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from dataclasses import dataclass
from types import SimpleNamespace

import pytest

pytest.importorskip("optuna", reason="the extra [evaluation] is not installed")

from optuna.distributions import CategoricalDistribution as Choice
from optuna.distributions import FloatDistribution as Real
from optuna.distributions import IntDistribution as Integer

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.search_space import search_space
from vehicle_pf_tracker.evaluation.tuning_aims import default_search
from vehicle_pf_tracker.parameters.table import parameter, specs, to_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS, find_variant


def space_of(name, *words, **changed):
    variant = find_variant(name)
    return search_space(variant, {**to_mapping(variant.parameters()), **changed}, words)


@pytest.mark.parametrize("name", VARIANTS)
def test_every_variant_has_a_space_that_holds_its_defaults_and_keeps_to_the_bounds(name):
    space = space_of(name)
    assert len(space) >= 2
    table = specs(find_variant(name).parameters)
    for parameter_name, found in space.items():
        spec = table[parameter_name]
        if isinstance(found, Choice):
            assert spec.default in found.choices
        else:
            assert found.low <= spec.default <= found.high and found.low < found.high
            for end in (found.low, found.high):
                spec.check(end)


def test_the_default_search_is_marked_in_the_table():
    assert default_search(find_variant("apf")) == [
        "motion.sigma_w",
        "likelihood.sigma_v",
        "occlusion.level.enter",
        "occlusion.level.certain",
        "velocity.window",
    ]


def test_a_mark_may_carry_the_range():
    @dataclass(frozen=True)
    class Parameters:
        wide: float = parameter(1.0, "Wider.", bounds=(0.0, 100.0), tuned=True)
        narrow: float = parameter(1.0, "Narrower.", bounds=(0.0, 100.0), tuned=(0.5, 1.5))
        still: float = parameter(1.0, "Not searched.")

    variant = SimpleNamespace(name="made", parameters=Parameters)
    assert search_space(variant, to_mapping(Parameters()), []) == {
        "wide": Real(0.25, 4.0, log=True),
        "narrow": Real(0.5, 1.5),
    }


@pytest.mark.parametrize(
    ("name", "word", "expected"),
    [
        ("pf", "sigma", Real(2.0, 32.0, log=True)),
        ("pf", "num_particles", Integer(50, 800, log=True)),
        ("pf", "histogram_bits", Integer(1, 5, log=True)),
        ("apf", "occlusion.tau", Real(0.0, 1.0)),
        ("apf", "as_printed", Choice((False, True))),
        ("mfpf", "estimate", Choice(("mean", "best"))),
        ("pf", "sigma=3:5", Real(3.0, 5.0)),
        ("pf", "sigma=1:50", Real(1.0, 50.0, log=True)),
        ("apf", "velocity.window=0:20", Integer(0, 20)),
    ],
)
def test_ranges_come_from_the_table_or_the_user(name, word, expected):
    assert space_of(name, word) == {word.partition("=")[0]: expected}


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("sgima", "did you mean 'sigma'"),
        ("seed", "no parameter 'seed'"),
        ("sigma=5", "NAME=LOW:HIGH, got sigma=5"),
        ("sigma=5:2", "range of sigma is empty"),
        ("sigma=0:2", r"sigma must be from 0.01 to 1000, got 0.0"),
        ("sigma=a:2", "sigma must be a number, got 'a'"),
        ("resampling=a:b", "NAME=LOW:HIGH, got resampling=a:b"),
        ("window.width", "gives no range: --search window.width=LOW:HIGH"),
    ],
)
def test_mistakes_are_told(word, said):
    with pytest.raises(InputError, match=said):
        space_of("pf", word)


def test_a_variant_without_marks_needs_names():
    @dataclass(frozen=True)
    class Parameters:
        still: float = parameter(1.0, "Not searched.")

    variant = SimpleNamespace(name="made", parameters=Parameters)
    with pytest.raises(InputError, match="no parameter of made is marked as tuned"):
        search_space(variant, to_mapping(Parameters()), [])
