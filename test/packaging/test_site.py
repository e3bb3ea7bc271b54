# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The site of `make docs` asks no other machine for anything, and its search works as files."""

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

import pytest

ROOT = Path(__file__).parents[2]
SHIM = ROOT / "tools" / "iframe-worker.js"
IN_STYLES = re.compile(r"""(?:url\(|@import)\s*["']?\s*([^"')\s;]+)""")
RELATED = {"canonical", "next", "prev", "alternate"}
"""Links of a page's head that a browser does not load."""
HTML = """<!doctype html><body><script src="iframe-worker.js"></script><script>
const worker = new Worker("worker.js");
worker.onmessage = ({data}) => document.body.append(data);
const missing = new Worker("missing.js");
missing.onerror = ({message}) => document.body.append(message);
worker.postMessage(20);
</script></body>"""
WORKER = """
addEventListener("message", async ({data}) => {
  await importScripts("first.js", "second.js");
  postMessage(`the answer is ${second(data)}`);
});
"""


class Loaded(HTMLParser):
    """Collects the addresses that a browser loads for a page."""

    def __init__(self):
        super().__init__()
        self.addresses, self._is_style = [], False

    def handle_starttag(self, tag, attrs):
        values = {name: value or "" for name, value in attrs}
        self._is_style = tag == "style"
        names = ("src", "srcset", "poster", "data", *["href"] * (tag in {"link", "image", "use"}))
        if not (tag == "link" and RELATED & set(values.get("rel", "").split())):
            self.addresses += [values[name].split()[0] for name in names if values.get(name)]
        self.addresses += IN_STYLES.findall(values.get("style", ""))

    def handle_data(self, data):
        if self._is_style:
            self.addresses += IN_STYLES.findall(data)


def loaded(path):
    """Return the addresses in a page or a style sheet."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".css":
        return IN_STYLES.findall(text)
    page = Loaded()
    page.feed(text)
    return page.addresses


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Build the site; return its folder."""
    for tool in ("mkdocs", "material", "mkdocstrings"):
        pytest.importorskip(tool, reason=f"needs {tool}, which `make docs` installs")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-d", folder]
    env = {**os.environ, "PYTHONPATH": str(ROOT), "NO_MKDOCS_2_WARNING": "true"}
    subprocess.run(command, cwd=ROOT, env=env, check=True)
    return folder


@pytest.mark.parametrize(
    ("text", "addresses"),
    [
        ('<script src="https://a.example/x.js"></script>', ["https://a.example/x.js"]),
        ('<link rel="stylesheet" href="//a.example/x.css">', ["//a.example/x.css"]),
        ('<link rel="canonical" href="https://a.example/">', []),
        ('<a href="https://a.example/">read</a>', []),
        ('<img src="x.png" srcset="http://a.example/x.png 2x">', ["x.png", "http://a.example/x.png"]),
        ("<style>@import 'http://a.example/f.css';</style>", ["http://a.example/f.css"]),
        ('<p style="background: url(x.png)">', ["x.png"]),
    ],
)  # fmt: skip
def test_what_a_browser_loads_is_noticed(tmp_path, text, addresses):
    path = tmp_path / "page.html"
    path.write_text(text)
    assert loaded(path) == addresses


@pytest.mark.slow
def test_pages_and_styles_load_files_of_the_site_alone(site):
    pages = [path for kind in ("*.html", "*.css") for path in site.rglob(kind)]
    assert len(pages) > 25
    for page in pages:
        for address in loaded(page):
            if address.startswith("data:"):
                continue
            target = urlsplit(urljoin(page.as_uri(), address))
            assert target.scheme == "file", f"{page.relative_to(site)} loads {address}"
            # The page of errors belongs to a server, and counts from its root.
            if page.name != "404.html":
                assert Path(unquote(target.path)).exists(), f"{page}: {address}"


@pytest.mark.slow
@pytest.mark.parametrize(("page", "words"), [("index", "occlusion"), ("road", "homography")])
def test_search_finds_pages_in_chromium_without_a_network(site, browse, page, words):
    elements = browse(f"{(site / page).as_uri()}.html?q={words}")
    number = re.search(r'class="md-search-result__meta">(\d+) matching document', elements)
    assert number, "the search has not answered"
    assert int(number[1]) >= 1
    first = re.search(r'<a href="([^"]*)" class="md-search-result__link"', elements)
    assert first
    assert words in Path(unquote(urlsplit(first[1]).path)).read_text(encoding="utf-8").lower()


@pytest.mark.slow
def test_the_rooms_are_drawn_in_the_site(site, browse):
    elements = browse((site / "development.html").as_uri())
    assert re.search(r'<img [^>]*src="images/rooms\.svg"', elements)
    assert "graph TD" not in elements


def test_a_worker_of_a_page_that_is_a_file_runs_and_loads_scripts(tmp_path, browse):
    (tmp_path / "iframe-worker.js").write_text(SHIM.read_text())
    (tmp_path / "page.html").write_text(HTML)
    (tmp_path / "worker.js").write_text(WORKER)
    (tmp_path / "first.js").write_text("const first = number => 2 * number;")
    (tmp_path / "second.js").write_text("var second = number => first(number) + 2;")
    elements = browse((tmp_path / "page.html").as_uri())
    assert "the answer is 42" in elements
    assert re.search(r"cannot load [^<]*missing\.js", elements)
