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

from dataclasses import dataclass
from types import SimpleNamespace

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.search_space import (
    Dimension,
    default_search,
    search_space,
)
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
    for dimension in space:
        spec = table[dimension.name]
        assert dimension.covers(spec.default)
        if not dimension.choices:
            assert dimension.low < dimension.high
            for end in (dimension.low, dimension.high):
                spec.check(int(end) if spec.kind is int else end)


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
    assert search_space(variant, to_mapping(Parameters()), []) == [
        Dimension("wide", float, 0.25, 4.0, logarithmic=True),
        Dimension("narrow", float, 0.5, 1.5),
    ]


@pytest.mark.parametrize(
    ("name", "word", "expected"),
    [
        ("pf", "sigma", Dimension("sigma", float, 2.0, 32.0, logarithmic=True)),
        ("pf", "num_particles", Dimension("num_particles", int, 50, 800, logarithmic=True)),
        ("pf", "histogram_bits", Dimension("histogram_bits", int, 1, 5, logarithmic=True)),
        ("apf", "occlusion.tau", Dimension("occlusion.tau", float, 0.0, 1.0)),
        ("apf", "as_printed", Dimension("as_printed", bool, choices=(False, True))),
        ("mfpf", "estimate", Dimension("estimate", str, choices=("mean", "best"))),
        ("pf", "sigma=3:5", Dimension("sigma", float, 3.0, 5.0)),
        ("pf", "sigma=1:50", Dimension("sigma", float, 1.0, 50.0, logarithmic=True)),
        ("apf", "velocity.window=0:20", Dimension("velocity.window", int, 0.0, 20.0)),
    ],
)
def test_ranges_come_from_the_table_or_the_user(name, word, expected):
    assert space_of(name, word) == [expected]


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


def test_a_name_twice_is_told():
    with pytest.raises(InputError, match="names sigma twice"):
        space_of("pf", "sigma", "sigma=1:2")


def test_numbers_are_tidied_and_stay_in_range():
    dimension = Dimension("sigma", float, 0.5, 1.23444)
    assert dimension.tidy(0.7654321) == 0.7654
    assert dimension.tidy(0.5) == 0.5
    assert dimension.tidy(1.23444) == 1.234
    assert Dimension("sigma", float, 0.5, 1.23456).tidy(1.23456) == 1.23456
    assert Dimension("n", int, 1, 5).tidy(3) == 3


def test_a_variant_without_marks_needs_names():
    @dataclass(frozen=True)
    class Parameters:
        still: float = parameter(1.0, "Not searched.")

    variant = SimpleNamespace(name="made", parameters=Parameters)
    with pytest.raises(InputError, match="no parameter of made is marked as tuned"):
        search_space(variant, to_mapping(Parameters()), [])
