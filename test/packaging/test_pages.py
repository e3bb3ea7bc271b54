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

"""What the pages promise: their links lead somewhere, and every page is linked."""

import re
from pathlib import Path

import pytest

from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.trackers.registry import VARIANTS

ROOT = Path(__file__).parents[2]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)")


def anchors(page: Path) -> set[str]:
    """Names of the headings as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
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
