# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page of `pick` in a real browser: shapes drawn, edited and removed, answers taken."""

import threading
from pathlib import Path

from small_recordings import COUNT, record

from vehicle_pf_tracker.cli import pick
from vehicle_pf_tracker.cli.pick_page import Editor, FrameStore
from vehicle_pf_tracker.cli.picked_shapes import SECTION_USES
from vehicle_pf_tracker.recordings.source import open_source

_HANDS = """
  const at = id => document.getElementById(id);
  const svg = at("drawing"), image = at("image"), slider = at("frame");
  svg.setPointerCapture = () => {};  // no such pointer
  const until = async is => { while (!is()) await new Promise(go => setTimeout(go, 20)); };
  const is_shown = number => svg.dataset.frame === String(number);
  const pointer = (kind, x, y) => {
    const area = svg.getBoundingClientRect();
    svg.dispatchEvent(new PointerEvent("pointer" + kind, {
      clientX: area.left + x / image.naturalWidth * area.width,
      clientY: area.top + y / image.naturalHeight * area.height}));
  };
  const drag = (x, y, to_x, to_y) => {
    pointer("down", x, y); pointer("move", (x + to_x) / 2, to_y);
    pointer("move", to_x, to_y); pointer("up", to_x, to_y);
  };
  const click = (...places) => {
    for (const [x, y] of places) { pointer("down", x, y); pointer("up", x, y); }
  };
  const draw_a = kind => document.querySelector(`#kinds [value=${kind}]`).click();
  const rows = () => [...at("list").children];
  const fields = row => [...rows()[row].querySelectorAll("input")];
  const go_to = async number => {
    slider.value = number; slider.dispatchEvent(new Event("input"));
    await until(() => is_shown(number));
  };
  const type = (field, text) => { field.value = text; field.dispatchEvent(new Event("input")); };
"""


def driven(tmp_path, browse, script, sections=tuple(SECTION_USES), first=1, document=None):
    """Let a browser run the page with `script`; returns what was drawn and the page's end."""
    page = Path(pick.__file__).with_name("pick.html").read_text(encoding="utf-8")
    script = f"(async () => {{ await until(() => is_shown({first})); {script} }})();"
    page = page.replace("</body>", f"<script>{_HANDS}{script}</script></body>")

    class Driven(Editor):
        def content(self, what):
            own = ("text/html; charset=utf-8", page.encode())
            return own if what == "driven" else super().content(what)

    frames = FrameStore(open_source(record(tmp_path / "bag")))
    with Driven(frames, list(sections), first, document or {}) as editor:
        thread = threading.Thread(target=editor.serve_forever)
        thread.start()
        try:
            page = browse(editor.url + "driven")
        finally:
            if not editor.drawn:
                editor.shutdown()  # the script did not come to its end
            thread.join(timeout=30)
    return rounded(editor.drawn), page


def rounded(drawn):
    """Round numbers, of which a pointer hits none exactly."""
    if isinstance(drawn, dict):
        return {name: rounded(one) for name, one in drawn.items()}
    if isinstance(drawn, list):
        return list(map(rounded, drawn))
    return round(drawn) if isinstance(drawn, float) else drawn


_DONE = """
      at("done").click();
      await until(() => at("said").textContent);
"""


def test_boxes_are_dragged_in_chromium(tmp_path, browse):
    script = """
      drag(30, 30, 10, 20);          // from the lower right
      drag(50, 50, 51, 50.5);        // too small
      drag(60, 20, 80, 44);
      rows()[0].querySelector("button").click();
      await go_to(5);
      drag(70, 50, 200, 200);        // beyond the image
      type(fields(1)[0], "white van!");
      document.body.dataset.shapes = svg.querySelectorAll("path.other").length;
    """
    drawn, page = driven(tmp_path, browse, script + _DONE, first=2)
    assert drawn == {
        "targets": [
            {"name": "2", "frame": 2, "box": [60, 20, 20, 24]},
            {"name": "whitevan", "frame": 5, "box": [70, 50, 26, 14]},
        ]
    }
    assert 'data-shapes="1"' in page  # that of the other frame is drawn apart
    assert "Finished; this page can be closed." in page
    assert f'max="{COUNT}"' in page


def test_points_are_clicked_in_chromium(tmp_path, browse):
    script = """
      const states = [];
      click([10, 10], [80, 10], [80, 60], [10, 60]);
      states.push(at("done").disabled);
      const all = [...document.querySelectorAll('li input:not([placeholder="name"])')];
      all.slice(0, 7).forEach(one => type(one, "1,5"));
      states.push(at("done").disabled);
      type(all[7], "-3");
      states.push(at("done").disabled);
      document.body.dataset.states = states;
    """
    drawn, page = driven(tmp_path, browse, script + _DONE, sections=["pairs"])
    assert 'data-states="true,true,false"' in page
    assert [pair["pixel"] for pair in drawn["pairs"]] == [[10, 10], [80, 10], [80, 60], [10, 60]]
    assert [pair["road"] for pair in drawn["pairs"]] == [[2, 2]] * 3 + [[2, -3]]  # 1.5, rounded


def test_lines_and_zones_are_drawn_in_chromium(tmp_path, browse):
    script = """
      draw_a("lines");
      drag(5, 50, 90, 52);
      draw_a("zones");
      click([5, 5], [40, 5], [40, 30], [20, 40], [5, 5]);    // the last closes it
      draw_a("roi");
      click([50, 5], [90, 5], [90, 40], [50, 5]);
      const side = at("list").querySelector("select");
      side.value = "outside";
      side.dispatchEvent(new Event("change"));
      click([70, 50], [90, 55]);
      document.dispatchEvent(new KeyboardEvent("keydown", {key: "Escape"}));    // none after all
      type(fields(0)[1], "away");
      type(fields(1)[0], "exit");
      type(fields(0)[0], "exit");
      at("done").click();
      await until(() => at("said").textContent.includes("rename"));
      document.body.dataset.refused = at("said").textContent;
      type(fields(0)[0], "stop");
    """
    drawn, page = driven(tmp_path, browse, script + _DONE)
    assert "is the name of a line and of a zone; rename one" in page
    assert drawn == {
        "lines": {"stop": {"from": [5, 50], "to": [90, 52], "directions": ["away", "out"]}},
        "zones": {"exit": [[5, 5], [40, 5], [40, 30], [20, 40]]},
        "roi": {"region 1": {"outside": [[50, 5], [90, 5], [90, 40]]}},
    }


def test_a_file_is_edited_in_chromium(tmp_path, browse):
    document = {
        "targets": [
            {"name": "van", "frame": 1, "box": [10, 10, 20, 10]},
            {"name": "car", "frame": 3, "box": [60, 10, 20, 10]},
        ],
        "lines": {"exit": {"from": [5, 50], "to": [90, 50], "directions": ["in", "out"]}},
        "zones": {"queue": [[40, 30], [90, 30], [90, 45]]},
    }
    script = """
      drag(30, 20, 35, 25);          // a corner of the box
      drag(50, 50, 50, 55);          // the line as a whole
      drag(90, 45, 90, 40);          // a corner of the zone
      drag(60, 10, 64, 25);          // a new box: that of frame 3 is not there to be moved
      document.body.dataset.selected = document.querySelector(".selected input").value;
      document.dispatchEvent(new KeyboardEvent("keydown", {key: "Delete"}));
      rows()[1].click();             // shows frame 3
      await until(() => is_shown(3));
      document.body.dataset.frame = at("number").value;
      drag(60, 15, 65, 15);          // now it is
      type(fields(3)[0], "jam");
    """
    drawn, page = driven(tmp_path, browse, script + _DONE, document=document)
    assert 'data-selected="1"' in page
    assert 'data-frame="3"' in page
    assert drawn == {
        "targets": [
            {"name": "van", "frame": 1, "box": [10, 10, 25, 15]},
            {"name": "car", "frame": 3, "box": [65, 10, 20, 10]},
        ],
        "lines": {"exit": {"from": [5, 55], "to": [90, 55], "directions": ["in", "out"]}},
        "zones": {"jam": [[40, 30], [90, 30], [90, 40]]},
    }
