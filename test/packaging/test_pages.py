# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What the pages promise: their links lead somewhere, every page is linked, sentences are short."""

import re
from pathlib import Path

import pytest

from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.trackers.registry import VARIANTS

ROOT = Path(__file__).parents[2]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
NOTES = sorted((ROOT / "laboratory" / "notes").glob("*.md"))
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)")


def anchors(page: Path) -> set[str]:
    """Names of the headings as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", [*PAGES, *NOTES], ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for target, anchor in LINK.findall(page.read_text(encoding="utf-8")):
        found = page.parent / target if target else page
        assert found.exists(), f"{page.name} links to {target}"
        if anchor:
            assert anchor in anchors(found), f"{page.name} links to {target}#{anchor}"


def test_every_page_can_be_found():
    linked = {
        (page.parent / target).resolve()
        for page in PAGES
        for target, _ in LINK.findall(page.read_text(encoding="utf-8"))
    }
    assert {page for page in PAGES if page.name != "README.md"} <= linked


MOST_WORDS = 40
"""Words of a sentence that a reader follows at the first reading."""


def sentences(page: Path) -> list[str]:
    """Text of a page without blocks of code and tables, split behind stops, titles and pictures."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.M)
    text = re.sub(r"^\|.*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"^(#|!\[).*$", ".", text, flags=re.MULTILINE)
    return re.split(r"(?<=[.!?])\s+", text)


def test_sentences_are_short():
    long = {
        f"{page.name}: {sentence}"
        for page in PAGES
        for sentence in sentences(page)
        if len(sentence.split()) > MOST_WORDS
    }
    assert not long


def rows_of(page: str, first: str) -> list[list[str]]:
    """Cells of the table rows whose first cell begins with `first`, without emphasis."""
    text = (ROOT / page).read_text(encoding="utf-8").replace("**", "")
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows if row[0].startswith(first)]


def recovered(row: list[str]) -> str:
    """Sum of cells like ``3 of 5``."""
    counts = [re.fullmatch(r"(\d+) of (\d+)", cell) for cell in row[1:]]
    good, judged = (sum(int(count[part]) for count in counts) for part in (1, 2))
    return f"{good} of {judged}"


def test_the_readme_gives_the_results_of_the_pages():
    claimed = {row[0]: row[1:] for row in rows_of("README.md", "") if len(row) == 4}
    (sequences,) = rows_of("docs/fusion.md", "of these, the 19")
    fitted = claimed["`fusion`, fitted on the 18 *other* cameras"]
    assert [f"0{value}" for value in fitted[:2]] == sequences[1:3]
    assert fitted[2] == sequences[3]
    named = {"`fusion` as it ships": "`fusion`", "OpenCV's CSRT": "`baseline:csrt`"}
    for tracker in ("`fusion` as it ships", "OpenCV's CSRT", "`apf`", "`pf`"):
        (name,) = [name for name in claimed if name.startswith(tracker)]
        on_target, _, occlusions = rows_of("docs/sequences.md", named.get(tracker, tracker))
        assert f"0{claimed[name][0]}" == on_target[-1]
        assert claimed[name][2] == recovered(occlusions)
    assert claimed["`fusion` as it ships"][1] == sequences[5].removeprefix("0")
    text = (ROOT / "docs/fusion.md").read_text(encoding="utf-8")
    csrt, nano = claimed["OpenCV's CSRT"], claimed["NanoTrack v2 (a neural network)"]
    assert f"CSRT has {csrt[0]} / {csrt[1]} on the 19 sequences" in text
    assert f"NanoTrack v2 {nano[0]} / {nano[1]}" in text


def interpretations() -> dict[int, str]:
    """Switches named for each interpretation of the papers, by its number."""
    page = (ROOT / "docs" / "interpretations.md").read_text(encoding="utf-8")
    return {
        int(number): switches
        for number, switches in re.findall(r"^\| (\d+) \|.*\|([^|]*)\|$", page, re.MULTILINE)
    }


def test_the_interpretations_that_code_refers_to_are_listed():
    listed = set(interpretations())
    for path in [
        *(ROOT / "vehicle_pf_tracker").rglob("*.py"),
        *(ROOT / "reproduction").rglob("*.py"),
    ]:
        text = path.read_text(encoding="utf-8")
        for numbers in re.findall(r"interpretations?\s+((?:\d+(?:, | to | and )?)+)", text):
            assert set(map(int, re.findall(r"\d+", numbers))) <= listed, path


def test_the_switches_of_interpretations_are_parameters():
    known = {name for variant in VARIANTS.values() for name in specs(variant.parameters)}
    named = set(re.findall(r"`([\w.]+): [^`]+`", " ".join(interpretations().values())))
    assert named
    assert named <= known
