# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml, to_yaml
from vehicle_pf_tracker.parameters.table import (
    from_mapping,
    group,
    parameter,
    parse_assignments,
    specs,
    to_mapping,
)
from vehicle_pf_tracker.trackers.registry import VARIANTS


@dataclass(frozen=True)
class Inner:
    sigma: float = parameter(2.0, "Spread.", bounds=(0.5, 9.0), unit="px")
    scheme: str = parameter("one", "Which.", choices=("one", "two"))

    def validate(self):
        if self.scheme == "two" and self.sigma > 8:
            raise InputError("scheme two wants sigma up to 8")


@dataclass(frozen=True)
class Outer:
    count: int = parameter(3, "How many.", bounds=(1, 100))
    quick: bool = parameter(True, "Whether.")
    inner: Inner = group(Inner, sigma=4.0)

    def validate(self):
        self.inner.validate()


def test_the_table_has_dotted_names_and_the_groups_changed_defaults():
    table = specs(Outer)
    assert list(table) == ["count", "quick", "inner.sigma", "inner.scheme"]
    assert table["inner.sigma"].default == 4.0
    assert table["inner.sigma"].unit == "px"
    assert table["count"].kind is int


def test_values_are_put_over_a_base():
    base = from_mapping(Outer, {"count": 7})
    made = from_mapping(Outer, {"inner.scheme": "two"}, base)
    assert to_mapping(made) == {
        "count": 7,
        "quick": True,
        "inner.sigma": 4.0,
        "inner.scheme": "two",
    }


def test_a_whole_number_does_for_a_real_one():
    made = from_mapping(Outer, {"inner.sigma": 6})
    assert made.inner.sigma == 6.0
    assert isinstance(made.inner.sigma, float)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"cuont": 1}, "did you mean 'count'"),
        ({"count": 0}, "from 1 to 100"),
        ({"count": 1.5}, "an integer"),
        ({"count": True}, "an integer"),
        ({"quick": 1}, "true or false"),
        ({"inner.sigma": 10.0}, "from 0.5 to 9"),
        ({"inner.sigma": float("nan")}, "finite"),
        ({"inner.sigma": "6"}, "a number"),
        ({"inner.sigma": None}, "a number"),
        ({"inner.scheme": "three"}, "one of one, two"),
        ({"inner.scheme": "two", "inner.sigma": 9.0}, "up to 8"),
    ],
)
def test_wrong_values_are_refused_by_name_and_remedy(values, told):
    with pytest.raises(InputError, match=told):
        from_mapping(Outer, values)


def test_every_problem_is_named_at_once():
    with pytest.raises(InputError) as refused:
        from_mapping(Outer, {"count": 0, "quick": "no", "inner.colour": 1})
    assert all(name in str(refused.value) for name in ("count", "quick", "inner.colour"))


def test_assignments_are_parsed_by_type():
    words = ["count=5", "quick=false", "inner.sigma=6", "inner.scheme=two"]
    assert parse_assignments(specs(Outer), words) == {
        "count": 5,
        "quick": False,
        "inner.sigma": 6.0,
        "inner.scheme": "two",
    }


@pytest.mark.parametrize("word", ["count", "count=many", "count=0", "quick=perhaps", "kount=3"])
def test_assignments_that_do_not_fit_are_refused(word):
    with pytest.raises(InputError):
        parse_assignments(specs(Outer), [word])


def test_yaml_goes_out_and_comes_back(tmp_path):
    made = from_mapping(Outer, {"count": 9, "inner.sigma": 0.1 + 0.5})
    path = tmp_path / "parameters.yaml"
    path.write_text(to_yaml(specs(Outer), to_mapping(made), "outer"))
    assert from_mapping(Outer, read_yaml(path, "any_tracker")) == made
    assert "# Spread. [px; from 0.5 to 9]" in path.read_text()


@pytest.mark.parametrize("variant", VARIANTS.values(), ids=list(VARIANTS))
def test_every_variants_defaults_survive_yaml(variant, tmp_path):
    path = tmp_path / "parameters.yaml"
    defaults = variant.parameters()
    path.write_text(to_yaml(specs(variant.parameters), to_mapping(defaults), variant.name))
    assert from_mapping(variant.parameters, read_yaml(path, f"{variant.name}_tracker")) == defaults


@pytest.mark.parametrize(
    "section", ["/**", "apf_tracker", "/apf_tracker", "/camera_1/apf_tracker", "/*/apf_tracker"]
)
def test_sections_for_this_node_count(tmp_path, section):
    path = tmp_path / "p.yaml"
    path.write_text(f"{section}:\n  ros__parameters:\n    inner: {{sigma: 3.5}}\n    count: 4\n")
    assert read_yaml(path, "apf_tracker") == {"inner.sigma": 3.5, "count": 4}


def test_nested_namespaces_and_later_sections_win(tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text(
        "/**:\n  ros__parameters: {count: 1, quick: false}\n"
        "camera:\n  apf_tracker:\n    ros__parameters: {count: 2}\n"
        "pf_tracker:\n  ros__parameters: {count: 3}\n"
    )
    assert read_yaml(path, "apf_tracker") == {"count": 2, "quick": False}
    assert read_yaml(path, "/camera/apf_tracker") == {"count": 2, "quick": False}
    assert read_yaml(path, "/apf_tracker") == {"count": 1, "quick": False}


@pytest.mark.parametrize(
    ("section", "is_meant"),
    [
        ("apf_tracker", False),
        ("/camera/apf_tracker", True),
        ("/camera/*", True),
        ("/*/apf_tracker", True),
        ("/**/apf_tracker", True),
        ("/**", True),
        ("/*", False),
        ("/*/*/apf_tracker", False),
        ("/camera/pf_tracker", False),
    ],
)
def test_a_section_is_for_a_node_by_its_full_name_as_in_ros(tmp_path, section, is_meant):
    path = tmp_path / "p.yaml"
    path.write_text(f"{section}:\n  ros__parameters: {{count: 3}}\n")
    if is_meant:
        assert read_yaml(path, "/camera/apf_tracker") == {"count": 3}
    else:
        with pytest.raises(InputError, match="has nothing for /camera/apf_tracker, only for /"):
            read_yaml(path, "/camera/apf_tracker")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a: [1, 2", "not valid YAML"),
        ("", "no ros__parameters"),
        ("- 1", "no ros__parameters"),
        ("other_node:\n  ros__parameters: {a: 1}\n", "nothing for apf_tracker"),
        ("\x00", "not valid YAML"),
    ],
)
def test_files_that_cannot_be_used_say_why(tmp_path, text, told):
    path = tmp_path / "p.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=told):
        read_yaml(path, "apf_tracker")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"nowhere\.yaml"):
        read_yaml(tmp_path / "nowhere.yaml", "apf_tracker")


@given(st.dictionaries(st.text(max_size=12), st.none() | st.floats() | st.text() | st.integers()))
def test_no_mapping_does_anything_but_fit_or_be_refused(values):
    try:
        made = from_mapping(Outer, values)
    except InputError:
        return
    assert 0.5 <= made.inner.sigma <= 9.0


@pytest.mark.parametrize("kind", [np.int8, np.uint8, np.int32, np.int64, np.float32, np.float64])
def test_numbers_of_numpy_are_numbers(kind):
    values = to_mapping(from_mapping(Outer, {"inner.sigma": kind(4)}))
    assert values["inner.sigma"] == 4.0
    assert type(values["inner.sigma"]) is float
    if np.issubdtype(kind, np.integer):
        assert type(from_mapping(Outer, {"count": kind(7)}).count) is int


def test_the_other_scalars_of_numpy_are_as_those_of_python():
    made = from_mapping(Outer, {"quick": np.bool_(False), "inner.scheme": np.str_("two")})
    assert (made.quick, made.inner.scheme) == (False, "two")
    assert type(made.quick) is bool
    assert from_mapping(Outer, {"inner.sigma": np.array(3.0)}).inner.sigma == 3.0
    for value in (np.float64(7), np.bool_(True), np.array([7])):
        with pytest.raises(InputError, match="count must be an integer"):
            from_mapping(Outer, {"count": value})
    with pytest.raises(InputError, match="finite"):
        from_mapping(Outer, {"inner.sigma": np.float32(np.nan)})
