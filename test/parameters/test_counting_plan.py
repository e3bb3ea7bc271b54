# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Reading of lines and zones: what is accepted, and the sentence for what is not."""

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.counting_plan import (
    CountingLine,
    CountingPlan,
    CountingZone,
    Region,
    read_counting_plan,
)

GOOD = """
lines:
  stop line: {from: [0, 120], to: [320.5, 118], directions: [towards, away]}
  exit: {from: [0, 20], to: [320, 20]}
zones:
  queue: [[0, 60], [320, 60], [320, 120], [0, 120]]
roi:
  road: {inside: [[0, 60], [320, 60], [320, 240]]}
  caption: {outside: [[0, 0], [90, 0], [90, 16]]}
"""


@pytest.fixture
def read(tmp_path):
    def read(text):
        path = tmp_path / "lines.yaml"
        path.write_text(text)
        return read_counting_plan(path)

    return read


def test_lines_zones_and_regions_are_read(read):
    assert read(GOOD) == CountingPlan(
        lines=(
            CountingLine("stop line", (0, 120), (320.5, 118), ("towards", "away")),
            CountingLine("exit", (0, 20), (320, 20), ("in", "out")),
        ),
        zones=(CountingZone("queue", ((0, 60), (320, 60), (320, 120), (0, 120))),),
        regions=(
            Region(((0, 60), (320, 60), (320, 240)), is_inside=True),
            Region(((0, 0), (90, 0), (90, 16)), is_inside=False),
        ),
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must have keys of these: lines, zones, roi"),
        ("[]", "must have keys of these: lines, zones, roi"),
        ("lines: {}", "neither a line nor a zone nor a region"),
        ("line: {a: {from: [0, 0], to: [9, 9]}}", "did you mean 'lines'"),
        ("lines: [{from: [0, 0], to: [9, 9]}]", "lines must be a mapping by name"),
        ("lines: {a: {from: [0, 0], to: [9, 9]}, a: {from: [1, 0], to: [9, 9]}}", "there twice"),
        ("lines: {a: {form: [0, 0], to: [9, 9]}}", "did you mean 'from'"),
        ("lines: {a: {colour: red}}", "known: from, to, directions"),
        ("lines: {a: {from: [0, 0]}}", "the line 'a' lacks the point 'to'"),
        ("lines: {a: {from: [0, 0], to: [0, 0]}}", "shorter than a pixel"),
        ("lines: {a: {from: [0, 0], to: [0]}}", "the point [0], which is not [x, y]"),
        ("lines: {a: {from: [0, 0], to: [0, .nan]}}", "which is not [x, y] in px"),
        ("lines: {a: {from: [0, 0], to: [0, .inf]}}", "which is not [x, y] in px"),
        ("lines: {a: {from: [0, 0], to: [0, true]}}", "which is not [x, y] in px"),
        ("lines: {a: {from: [0, 0], to: [0, '9']}}", "which is not [x, y] in px"),
        ("lines: {a: {from: [0, 0], to: 5}}", "which is not [x, y] in px"),
        ("lines: {a: 3}", "the line 'a' must have keys of these: from, to"),
        ("lines: {no: {from: [0, 0], to: [9, 9]}}", "name False, which is not text"),
        ("lines: {'': {from: [0, 0], to: [9, 9]}}", "which is not text"),
        ("lines: {a: {from: [0, 0], to: [9, 9], directions: [in]}}", "two different names"),
        ("lines: {a: {from: [0, 0], to: [9, 9], directions: [in, in]}}", "two different names"),
        ("lines: {a: {from: [0, 0], to: [9, 9], directions: in}}", "two different names"),
        ("lines: {a: {from: [0, 0], to: [9, 9], directions: [on, off]}}", "put them in quotes"),
        ("zones: {a: [[0, 0], [9, 9]]}", "three corners or more"),
        ("zones: {a: [[0, 0], [9, 9], [18, 18]]}", "has no area"),
        ("zones: {a: [[0, 0], [9, 9], [9, 0], [0, 12]]}", "crosses itself"),
        (f"zones: {{a: {[[k, k * k] for k in range(101)]}}}", "more than 100 corners"),
        ("roi: {a: {within: [[0, 0], [9, 0], [9, 9]]}}", "known: inside, outside"),
        ("roi: {a: {}}", "the region 'a' must have one of the keys inside and outside"),
        ("roi: {a: {inside: [[0, 0], [9, 9]]}}", "the region 'a' needs three corners"),
        (
            "lines: {a: {from: [0, 0], to: [9, 9]}}\nzones: {a: [[0, 0], [9, 0], [9, 9]]}",
            "the name of a line and of a zone",
        ),
        ("lines: &x {a: *x}", "aliases are not supported"),
        ("lines: {", "not valid YAML"),
    ],
)
def test_a_mistake_is_one_sentence_that_names_the_file(read, text, said):
    with pytest.raises(InputError) as error:
        read(text)
    assert said in str(error.value)
    assert "lines.yaml" in str(error.value)
    assert "\n" not in str(error.value)


def test_what_lies_outside_the_image_is_named():
    lines = (
        CountingLine("in", (-50.0, 100.0), (700.0, 100.0)),
        CountingLine("right", (700.0, 0.0), (700.0, 300.0)),
    )
    zones = (
        CountingZone("above", ((0.0, -9.0), (90.0, -9.0), (90.0, -60.0))),
        CountingZone("corner", ((600.0, 300.0), (900.0, 300.0), (900.0, 900.0))),
    )
    assert CountingPlan(lines, zones).outside(640, 360) == ["right", "above"]
