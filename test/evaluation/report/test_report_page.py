# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page, read as a browser would."""

import re
import shutil
from collections import Counter
from html.parser import HTMLParser

import pytest
from evaluation_samples import HIDDEN, NO_BASELINES, VARIANTS

from vehicle_pf_tracker.evaluation.report.writing import write_report

VOID = {"meta", "link", "img", "br", "line", "path", "use", "rect", "input", "hr"}


class Page(HTMLParser):
    """Every element with its attributes, and the text by the element it stands in."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.texts, self.open = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append((self.open[-1] if self.open else "", data))

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    def text(self, *tags):
        return " ".join(data for tag, data in self.texts if not tags or tag in tags)


@pytest.fixture(scope="module")
def written(made_evaluation, tmp_path_factory):
    folder = shutil.copytree(made_evaluation, tmp_path_factory.mktemp("written") / "evaluation")
    write_report(folder)
    return folder


@pytest.fixture(scope="module")
def text(written):
    return (written / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text):
    return Page(text)


def test_the_page_needs_nothing_else(page):
    for _, attributes in page.elements:
        for name in ("src", "href", "xlink:href", "action", "data", "poster", "srcset"):
            assert (attributes.get(name) or "#").startswith(("#", "data:image/jpeg;base64,"))
    assert not page.all("link") and not page.all("iframe")
    assert not any("src" in script for script in page.all("script"))
    styles = page.text("style")
    assert "url(" not in styles and "@import" not in styles
    (policy,) = [m["content"] for m in page.all("meta") if "http-equiv" in m]
    assert policy.startswith("default-src 'none'")
    assert "img-src data:;" in policy  # or a browser leaves out the stills
    assert page.all("img")


def test_every_element_is_closed_no_id_is_used_twice_and_links_lead_somewhere(page):
    assert page.open == []
    ids = Counter(attributes["id"] for _, attributes in page.elements if "id" in attributes)
    assert {name for name, count in ids.items() if count > 1} == set()
    links = [a["href"][1:] for a in page.all("a")]
    links += [u["xlink:href"][1:] for u in page.all("use")]
    assert len(links) > 10
    assert set(links) <= set(ids)


def test_pictures_and_tables_can_be_read_out(page):
    figures = [svg for svg in page.all("svg") if svg.get("aria-hidden") != "true"]
    assert all(svg["role"] == "img" and svg["aria-label"] for svg in figures)
    assert all(heading.get("scope") for heading in page.all("th"))
    assert len(page.all("caption")) >= 5


def test_it_shows_all_systems_and_recordings(page):
    assert set(VARIANTS) <= {data for tag, data in page.texts if tag == "span"}
    assert {data for tag, data in page.texts if tag == "h3"} >= set(HIDDEN)
    # Three curves, and for each recording the errors over time.
    figures = [svg for svg in page.all("svg") if svg.get("role") == "img"]
    assert len(figures) == 3 + len(HIDDEN)


def test_it_says_how_it_was_made_and_what_failed(page):
    assert "vehicle-pf-tracker evaluate free -o evaluation" in page.text("code")
    assert NO_BASELINES in page.text("td")
    assert "bridge: seed 0; free: seed 0" in page.text("td")
    assert "2 of 12 cells have no result" in page.text("li")
    assert "40" in page.text("strong")  # num_particles was set


def test_differences_to_the_first_have_intervals(page):
    rows = page.text("td")
    assert re.search(r"[+-]0\.\d{3} \(-?\d\.\d{3} to -?\d\.\d{3}\)", rows)


def test_colours_come_from_the_scheme(page, text):
    assert "prefers-color-scheme: dark" in page.text("style")
    drawn = "".join(re.findall("<svg.*?</svg>", text, re.DOTALL))
    assert "var(--s0)" in drawn and not re.search("(fill|stroke): #", drawn)


def test_tables_can_be_sorted_by_numbers(page):
    assert len(page.all("button")) > 20
    values = [cell["data-value"] for cell in page.all("td") if "data-value" in cell]
    assert len(values) > 50
    assert all(float(value) == float(value) for value in values)


def test_the_same_folder_gives_the_same_files(written):
    names = ["report.html", "summary.md", "summary.csv", "summary.tex", "summary.json"]
    before = [(written / name).read_bytes() for name in names]
    assert write_report(written).page == written / "report.html"
    assert [(written / name).read_bytes() for name in names] == before


def test_names_are_no_markup(evaluation_copy):
    plan = (evaluation_copy / "evaluation.json").read_text()
    (evaluation_copy / "evaluation.json").write_text(plan.replace('"-o"', '"<script>x</script>"'))
    page = Page(write_report(evaluation_copy).page.read_text())
    assert "<script>x</script>" in page.text("code")
    assert len(page.all("script")) == 1


def test_a_folder_without_any_result_still_has_a_report(made_evaluation, tmp_path):
    folder = tmp_path / "evaluation"
    folder.mkdir()
    shutil.copy(made_evaluation / "evaluation.json", folder)
    page = Page(write_report(folder).page.read_text())
    assert "12 of 12 cells have no result" in page.text("li")
    assert "No cell of this recording has a result." in page.text("p")


def test_the_summary_fits_a_screen_of_1280_px(text, tmp_path, browse):
    measuring = """<script>
      const frame = document.querySelector("#summary .scroll");
      document.body.dataset.widths = [frame.scrollWidth, frame.clientWidth, innerWidth];
    </script></body>"""
    long_names = text.replace("apf", "baseline:nanotrack")
    copy = tmp_path / "report.html"
    copy.write_text(long_names.replace("</body>", measuring))
    widths = re.search(r'data-widths="(\d+),(\d+),(\d+)"', browse(copy.as_uri()))
    needed, visible, screen = map(int, widths.groups())
    assert screen == 1280
    assert needed <= visible
