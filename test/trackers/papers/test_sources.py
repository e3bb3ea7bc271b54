# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What a parameter names as its source is in that paper, by the papers' own texts."""

import re
from pathlib import Path

import pytest

from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.trackers.registry import VARIANTS

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "papers"
TEXTS = {
    "P1": "apf_scharcanski_2011.txt",
    "P2": "mfpf_abdulla_2022.txt",
    "P3": "adaptive_resampling_khong.txt",
}
PAPER_OF = {
    **dict.fromkeys(("apf", "pf", "sapf", "pfcl", "hpfms", "ms"), "P1"),
    **dict.fromkeys(("mfpf", "sfpf_color", "sfpf_edge", "sfpf_texture"), "P2"),
    **dict.fromkeys(("conventional", "adaptive"), "P3"),
}
"""The paper that a variant's parameters may name: P1 describes the rivals of `apf` too."""
SOURCES = [
    (variant, name, spec.source)
    for variant in PAPER_OF
    for name, spec in specs(VARIANTS[variant].parameters).items()
    if re.search(r"\bP[123]\b", spec.source)
]


def text_of(paper):
    path = FOLDER / TEXTS[paper]
    if not path.is_file():
        pytest.skip(f"the papers' texts are not here ({path.name})")
    return path.read_text(encoding="utf-8")


def equations(paper):
    """Numbers of the equations that are printed: (4) at the end of a formula's line."""
    tags = re.findall(r"\((\d+)\)\s*(?:\$\$)?[.,;]?\s*$", text_of(paper), re.MULTILINE)
    return set(map(int, tags))


def sections(paper):
    """Sections that are printed, as III or III-C; a part goes to the section before it."""
    found, current = set(), ""
    for line in text_of(paper).splitlines():
        title = line.strip().lstrip("#* ").strip()
        if heading := re.match(r"(I{1,3}|IV|VI{0,2})\. [A-Z]", title):
            current = heading[1]
            found.add(current)
        elif current and (part := re.match(r"([A-H])\. [A-Z][a-z]", title)):
            found.add(f"{current}-{part[1]}")
    return found


def tables(paper):
    return set(re.findall(r"TABLE ([IVX]+)", text_of(paper)))


def named(source, pattern):
    return re.findall(pattern, source)


def test_every_paper_has_the_equations_that_it_is_known_for():
    assert equations("P1") >= {1, 7, 9, 10, 12, 20, 25}
    assert equations("P2") >= {1, 5, 7, 9, 10, 14, 19}
    assert equations("P3") >= {1, 6, 10, 13}
    assert max(equations("P1")) == 25
    assert max(equations("P2")) == 19
    assert max(equations("P3")) == 13


@pytest.mark.parametrize(("variant", "name", "source"), SOURCES)
def test_a_source_names_the_variants_own_paper(variant, name, source):
    assert set(named(source, r"\bP[123]\b")) == {PAPER_OF[variant]}


@pytest.mark.parametrize(("variant", "name", "source"), SOURCES)
def test_a_sources_equation_section_and_table_are_in_the_paper(variant, name, source):
    paper = PAPER_OF[variant]
    listed = " ".join(named(source, r"eq\. (\d+(?:(?:, | and )\d+)*)"))
    numbers = set(map(int, named(listed, r"\d+")))
    assert numbers <= equations(paper)
    places = set(named(source, r"\b([IVX]+-[A-Z])\b"))
    places |= set(named(source, r"sections? ([IVX]+)\b"))
    assert places <= sections(paper)
    assert set(named(source, r"Table ([IVX]+)")) <= tables(paper)
    steps = {int(n) for n in named(source, r"Algorithm 1 step (\d+)")}
    assert all(f"\n{n}:" in text_of(paper).replace("\n ", "\n") for n in steps)


@pytest.mark.parametrize(
    ("variant", "bad"), [("mfpf", "P2 eq. 25"), ("adaptive", "P3 section VIII-A")]
)
def test_a_wrong_source_is_seen(variant, bad):
    with pytest.raises(AssertionError):
        test_a_sources_equation_section_and_table_are_in_the_paper(variant, "", bad)
