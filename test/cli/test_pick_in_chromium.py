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

"""The page of `pick` in a real browser: boxes dragged, points clicked, answers taken."""

import threading
from pathlib import Path

from small_recordings import COUNT, record

from vehicle_pf_tracker.cli import pick
from vehicle_pf_tracker.cli.pick import BOXES, POINTS, FrameStore, PickingServer
from vehicle_pf_tracker.recordings.source import open_source

_HANDS = """
  svg.setPointerCapture = () => {};  // no such pointer
  const until = async is => { while (!is()) await new Promise(go => setTimeout(go, 20)); };
  const pointer = (kind, x, y) => {
    const area = svg.getBoundingClientRect();
    svg.dispatchEvent(new PointerEvent("pointer" + kind, {
      clientX: area.left + x / image.naturalWidth * area.width,
      clientY: area.top + y / image.naturalHeight * area.height}));
  };
  const drag = (x, y, to_x, to_y) => {
    pointer("down", x, y); pointer("move", (x + to_x) / 2, to_y); pointer("up", to_x, to_y);
  };
  const go_to = async number => {
    slider.value = number; slider.dispatchEvent(new Event("input"));
    await until(() => shown === number);
  };
  const type = (field, text) => { field.value = text; field.dispatchEvent(new Event("input")); };
"""


class DrivenHandler(pick.PageHandler):
    """Serves the page with a script that does what a user would."""

    script = ""

    def do_GET(self):  # noqa: N802 - the base's name
        if self._asked() != "driven":
            super().do_GET()
            return
        page = Path(pick.__file__).with_name("pick.html").read_text(encoding="utf-8")
        driven = page.replace("</body>", f"<script>{_HANDS}{self.script}</script></body>")
        self._answer("text/html; charset=utf-8", driven.encode())


def driven(server, browse, script):
    """Let a browser run the page with `script`; returns what was picked and the page's end."""
    server.RequestHandlerClass = type("Driven", (DrivenHandler,), {"script": script})
    picked = []
    thread = threading.Thread(target=lambda: picked.append(server.pick()))
    thread.start()
    try:
        page = browse(server.url + "driven")
    finally:
        if not picked:
            server.shutdown()  # the script did not come to its end
        thread.join(timeout=30)
    return picked[0], page


def test_boxes_are_dragged_in_chromium(tmp_path, browse):
    script = """(async () => {
      await until(() => shown === 2);
      drag(30, 30, 10, 20);          // from the lower right
      drag(50, 50, 51, 50.5);        // too small
      drag(60, 20, 80, 44);
      document.querySelector("li button").click();
      await go_to(5);
      drag(70, 50, 200, 200);        // beyond the image
      type(document.querySelectorAll("li input")[1], "white van!");
      document.body.dataset.shapes = svg.querySelectorAll("rect.other").length;
      at("done").click();
      await until(() => at("said").textContent);
    })();"""
    frames = FrameStore(open_source(record(tmp_path / "bag")))
    with PickingServer(frames, BOXES, first=2) as server:
        picked, page = driven(server, browse, script)
    near = [[round(v) for v in (t.box.x, t.box.y, t.box.width, t.box.height)] for t in picked]
    assert [(t.name, t.frame) for t in picked] == [("2", 2), ("whitevan", 5)]
    assert near == [[60, 20, 20, 24], [70, 50, 26, 14]]
    assert 'data-shapes="1"' in page  # that of the other frame is drawn apart
    assert "Finished; this page can be closed." in page
    assert f'max="{COUNT}"' in page


def test_points_are_clicked_in_chromium(tmp_path, browse):
    script = """(async () => {
      await until(() => shown === 1);
      const states = [];
      for (const [x, y] of [[10, 10], [80, 10], [80, 60], [10, 60]]) pointer("up", x, y);
      states.push(at("done").disabled);
      const fields = [...document.querySelectorAll("li input")];
      fields.slice(0, 7).forEach(field => type(field, "1,5"));
      states.push(at("done").disabled);
      type(fields[7], "-3");
      states.push(at("done").disabled);
      document.body.dataset.states = states;
      at("done").click();
      await until(() => at("said").textContent);
    })();"""
    frames = FrameStore(open_source(record(tmp_path / "bag")))
    with PickingServer(frames, POINTS) as server:
        picked, page = driven(server, browse, script)
    assert 'data-states="true,true,false"' in page
    assert [tuple(map(round, pair.pixel)) for pair in picked] == [
        (10, 10), (80, 10), (80, 60), (10, 60)
    ]  # fmt: skip
    assert [pair.road for pair in picked] == [(1.5, 1.5)] * 3 + [(1.5, -3.0)]
