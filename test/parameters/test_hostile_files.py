# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameter files that once hung, ended in a traceback, or hid what they said."""

import os

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml, read_yaml_file
from vehicle_pf_tracker.parameters.table import from_mapping, parse_assignments, specs
from vehicle_pf_tracker.trackers.papers.apf import ApfParameters

HEAD = "/**:\n  ros__parameters:\n"
NESTED = "[" * 100_000
BOMB = f"{HEAD}    a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"    {name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)
LONG = "1" * 4000  # as many digits as Python converts
TOO_LONG = "1" * 5000


pytestmark = pytest.mark.usefixtures("no_hang")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (NESTED, "nested too deeply"),
        ("a: " + "{a: " * 5000, "nested too deeply"),
        (f"{HEAD}    seed: {TOO_LONG}", "5000 digits"),
        ("/**: &a\n  ros__parameters: *a\n", "aliases are not supported"),
        (f"{HEAD}    x: &a [*a]\n", "aliases are not supported"),
        (f"{BOMB}    seed: *i\n", "aliases are not supported"),
        (f"{HEAD}    seed: 1\n    seed: 2\n", "the key 'seed' is there twice"),
        (f"{HEAD}    seed: 1\n{HEAD}    frame_rate: 2\n", "the key '/\\*\\*' is there twice"),
        (f"{HEAD}    target: {{x: 1.0, y: 2.0, x: 3.0}}\n", "the key 'x' is there twice"),
        (f"{HEAD}    seed: 2001-99-99\n", "is not valid YAML"),
        ("a: " + "x" * 2**20, "larger than 1 MB"),
    ],
)
def test_files_that_are_refused(tmp_path, text, said):
    path = tmp_path / "apf.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=said) as caught:
        read_yaml(path, "apf_tracker")
    assert len(str(caught.value)) < 500
    with pytest.raises(InputError, match=said):
        read_yaml_file(path, "parameter file")


def test_a_pipe_is_no_file(tmp_path):
    os.mkfifo(tmp_path / "apf.yaml")
    with pytest.raises(InputError, match="is not a regular file"):
        read_yaml(tmp_path / "apf.yaml", "apf_tracker")


@pytest.mark.parametrize(
    "value",
    [int(LONG), -int(LONG), [1] * 10**5, "x" * 10**5, {"a": int(LONG)}],
    ids=["long", "negative", "list", "text", "mapping"],
)
@pytest.mark.parametrize("name", ["num_particles", "motion.sigma_w", "resampling", "as_printed"])
def test_values_of_any_length_are_named_briefly(name, value):
    with pytest.raises(InputError, match=name) as caught:
        from_mapping(ApfParameters, {name: value})
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("name", ["num_particles", "motion.sigma_w"])
@pytest.mark.parametrize("value", [LONG, TOO_LONG, "1e999", "x" * 10**5], ids=lambda one: one[:5])
def test_assignments_of_any_length_are_named_briefly(name, value):
    with pytest.raises(InputError, match=name) as caught:
        parse_assignments(specs(ApfParameters), [f"{name}={value}"])
    assert len(str(caught.value)) < 400
