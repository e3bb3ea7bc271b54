# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`pick`: the page's server, spoken to as a browser would, the files, and the grid."""

import json
import shutil
import socket
import struct
import subprocess
import threading
import urllib.error
import urllib.request
from pathlib import Path

import cv2
import pytest
import yaml
from small_recordings import COUNT, frame_folder, frame_of, record

from vehicle_pf_tracker.cli import pick, pick_page
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.pick_page import Editor, FrameStore
from vehicle_pf_tracker.cli.picked_shapes import SECTION_USES
from vehicle_pf_tracker.image.formats.compressed_image import jpeg
from vehicle_pf_tracker.parameters.counting_plan import read_counting_plan
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import open_source

ANSWER = {
    "targets": [
        {"name": "van1", "frame": 3, "box": [10, 20.5, 16, 12]},
        {"name": "", "frame": 1, "box": [1, 2, 3, 4]},
    ]
}
ALL = {
    **ANSWER,
    "lines": {"exit": {"from": [0, 40], "to": [90, 40], "directions": ["away", "back"]}},
    "zones": {"queue": [[0, 0], [90, 0], [90, 30]]},
    "roi": {"near": {"inside": [[30, 50], [80, 50], [80, 63]]}},
    "pairs": [
        {"name": "post", "pixel": [8.5, 4], "road": [0, 20.25]},
        {"name": "2", "pixel": [90, 4], "road": [9, 20]},
        {"name": "3", "pixel": [90, 60], "road": [9, 0]},
        {"name": "4", "pixel": [8, 60], "road": [0, 0]},
    ],
}


@pytest.fixture
def answered(monkeypatch):
    """Let a user answer with this, or with what it makes of what the page is given to edit."""

    def use(made):
        def answer(url):
            document = made(json.loads(get(url + "info"))["document"]) if callable(made) else made
            get(url + "done", json.dumps(document).encode())

        def open_browser(url):
            threading.Thread(target=answer, args=(url,)).start()

        monkeypatch.setenv("DISPLAY", ":0")
        monkeypatch.setattr(pick_page.webbrowser, "open", open_browser)

    return use


@pytest.fixture
def server(tmp_path):
    """A server that answers until the test is over."""
    source = open_source(record(tmp_path / "bag"))
    with Editor(FrameStore(source), list(SECTION_USES), 2, {}) as made:
        thread = threading.Thread(target=made.serve_forever)
        thread.start()
        yield made
        if not made.drawn:
            get(made.url + "done", b"null")
        thread.join(timeout=30)
        assert not thread.is_alive()


def get(url, body=None):
    with urllib.request.urlopen(urllib.request.Request(url, body), timeout=30) as answer:
        return answer.read()


def status(url, body=None):
    return refusal(url, body)[0]


def refusal(url, body=None):
    try:
        get(url, body)
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
    return 200, ""


def test_the_page_and_any_frame_are_served(server):
    assert b"<title>Pick</title>" in get(server.url)
    assert b"fetch(" in get(server.url + "pick.js")
    facts = {"frames": COUNT, "frame": 2, "sections": list(SECTION_USES), "document": {}}
    assert json.loads(get(server.url + "info")) == facts
    for number in (5, 2, COUNT):
        assert get(f"{server.url}frame/{number}") == jpeg(frame_of(number - 1))


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("frame/0", None),
        (f"frame/{COUNT + 1}", None),
        ("frame/x", None),
        ("frame/" + 50 * "9", None),
        ("../secret", None),
        ("info", b"[]"),
    ],
)
def test_what_is_not_there_is_not_found(server, path, body):
    assert status(server.url + path, body) == 404
    assert status(server.url + "info") == 200  # it goes on waiting


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        (b"no json", "Expecting value"),
        (b"[3]", "other sections than targets, lines"),
        (b'{"boxes": []}', "other sections"),
        (b'{"targets": [{"box": [1, 2, NaN, 4]}]}', "not finite"),
        (b'{"targets": [{"name": "a b", "box": [1, 2, 3, 4]}]}', "is not [NAME][@FRAME:]x,y,w,h"),
        (b'{"targets": [3]}', "must read targets: [{name: van"),
        (b'{"zones": {"q": [[0, 0], [9, 9], [9, 0], [0, 8]]}}', "'q' crosses itself"),
        (b'{"pairs": [{"pixel": [1, 2], "road": [3, null]}]}', "must read pairs: ["),
    ],
)
def test_what_cannot_be_used_is_refused_in_a_sentence_and_can_be_mended(server, body, sentence):
    code, said = refusal(server.url + "done", body)
    assert code == 400
    assert sentence in said
    assert get(server.url + "done", json.dumps(ALL).encode()) == b"finished"
    assert server.drawn == ALL


def test_nobody_gets_in_without_the_token(server):
    root = server.url[: -len(server.base)]
    assert [status(root + path) for path in ("/", "/info", "/x/info")] == [404] * 3
    assert server.server_address[0] == "127.0.0.1"


def test_targets_are_printed_as_words_of_run(answered, tmp_path, capsys):
    answered(ANSWER)
    assert main(["pick", str(frame_folder(tmp_path / "frames"))]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == (
        "--target van1@3:10,20.5,16,12 --target @1:1,2,3,4"
    )


def test_targets_are_written_to_a_file_that_run_reads(answered, tmp_path, capsys):
    answered(ANSWER)
    path = tmp_path / "new" / "targets.yaml"
    folder = str(frame_folder(tmp_path / "frames"))
    assert main(["pick", folder, "-o", str(path)]) == 0
    assert yaml.safe_load(path.read_text()) == ANSWER
    words = ["--variant", "pf", "--targets", str(path), "-o", str(tmp_path / "out")]
    assert main(["run", folder, *words]) == 0
    assert "van1: WAITING 0:00.0-0:00.0, TRACKING" in capsys.readouterr().out


def test_nothing_picked_is_an_error(answered, tmp_path, capsys):
    answered({})
    frames = str(frame_folder(tmp_path / "frames"))
    for verb in (["pick"], ["pick", "--road"], ["road", "calibrate"]):
        assert main([*verb, frames]) == 2
        assert "nothing was picked" in capsys.readouterr().err


def test_no_frame_is_read_after_the_user_is_done():
    """A decoder at work while Python exits aborted the process after the targets were written."""
    read, asked = [], threading.Event()

    class Endless:
        frame_count = None

        def frames(self):
            while True:
                read.append(len(read))
                asked.set()
                yield StampedFrame(len(read), frame_of(0))

    store = FrameStore(Endless())
    thread = threading.Thread(target=store.jpeg, args=(10**9,))
    thread.start()
    assert asked.wait(30)
    store.close()
    count = len(read)
    thread.join(30)
    assert not thread.is_alive()
    assert (len(read), store.jpeg(1)) == (count, None)


def test_an_idle_connection_keeps_nobody_waiting(server):
    with socket.create_connection(server.server_address, timeout=30):
        assert status(server.url + "info") == 200


def test_a_browser_that_hangs_up_is_not_a_fault(server, capsys):
    for _ in range(20):
        with socket.create_connection(server.server_address, timeout=30) as connection:
            hard = struct.pack("ii", 1, 0)  # a reset, as when another frame is asked for
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, hard)
            connection.sendall(f"GET {server.base}frame/3 HTTP/1.1\r\n\r\n".encode())
    assert status(server.url + "info") == 200
    assert capsys.readouterr().err == ""


def test_without_a_display_no_browser_is_started(monkeypatch, tmp_path, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(pick_page.webbrowser, "open", lambda url: pytest.fail("opened"))
    monkeypatch.setattr(Editor, "serve_forever", lambda server, poll_interval: None)
    assert main(["pick", str(record(tmp_path / "bag"))]) == 2
    assert "open http://127.0.0.1:" in capsys.readouterr().out


def test_points_of_the_road_are_printed_as_words_or_written(answered, tmp_path, capsys):
    answered({"pairs": ALL["pairs"]})
    folder, path = str(frame_folder(tmp_path / "frames")), tmp_path / "pairs.yaml"
    assert main(["pick", folder, "--road"]) == 0
    words = capsys.readouterr().out.splitlines()[-1].split()
    assert words[:2] == ["--pair", "8.5,4.0=0.0,20.25"]
    assert main(["road", "calibrate", folder, *words]) == 0
    table = capsys.readouterr().out
    assert main(["pick", folder, "--road", "-o", str(path)]) == 0
    capsys.readouterr()
    assert main(["road", "calibrate", folder, "--pairs", str(path)]) == 0
    assert capsys.readouterr().out == table


def test_a_road_is_calibrated_on_the_page(answered, tmp_path):
    answered({"pairs": ALL["pairs"]})
    out, grid = tmp_path / "road.yaml", tmp_path / "check.png"
    folder = str(frame_folder(tmp_path / "frames"))
    assert main(["road", "calibrate", folder, "-o", str(out), "--grid", str(grid)]) == 0
    assert "8.5,4.0=0.0,20.25; 90.0,4.0=9.0,20.0" in out.read_text()
    assert grid.exists()


def test_one_file_has_it_all_and_is_edited_in_place(answered, tmp_path, capsys):
    def rename(document):
        assert document == ALL
        return {**document, "zones": {"jam": document["zones"]["queue"]}, "lines": {}}

    folder, path = str(frame_folder(tmp_path / "frames")), tmp_path / "all.yaml"
    answered(ALL)
    assert main(["pick", folder, "-o", str(path)]) == 0
    verbs = capsys.readouterr().out.splitlines()[-1].partition("; use ")[2]
    assert verbs == (
        f"run --targets {path} and traffic --lines {path} and road calibrate --pairs {path}"
    )
    assert [line.directions for line in read_counting_plan(path).lines] == [("away", "back")]
    answered(rename)
    assert main(["pick", folder, "--edit", str(path)]) == 0
    plan = read_counting_plan(path)
    assert ([zone.name for zone in plan.zones], plan.lines) == (["jam"], ())
    assert main(["road", "calibrate", folder, "--pairs", str(path)]) == 0
    copy = tmp_path / "copy.yaml"
    answered(lambda document: {"zones": document["zones"]})
    assert main(["pick", folder, "--edit", str(path), "-o", str(copy)]) == 0
    assert set(yaml.safe_load(copy.read_text())) == {"zones"}
    assert "targets" in yaml.safe_load(path.read_text())
    assert main(["pick", folder, "-o", str(copy)]) == 1  # it exists
    path.write_text("targets: [{name: 2026-01-01, box: [1, 2, 3, 4]}]")  # a date in YAML
    answered(lambda document: document)
    assert main(["pick", folder, "--edit", str(path)]) == 0
    assert yaml.safe_load(path.read_text())["targets"][0]["name"] == "2026-01-01"


def test_lines_are_printed_as_a_file_has_them(answered, tmp_path, capsys):
    answered({"lines": ALL["lines"]})
    assert main(["pick", str(frame_folder(tmp_path / "frames"))]) == 0
    printed = capsys.readouterr().out.partition("\n")[2]
    assert yaml.safe_load(printed) == {"lines": ALL["lines"]}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [("boxes: []", "other sections than"), ("zones: {q: [[1, 2]]}", "needs three corners")],
)
def test_a_file_that_cannot_be_edited_stays_as_it_is(tmp_path, capsys, text, sentence):
    path = tmp_path / "drawn.yaml"
    path.write_text(text)
    frames = str(frame_folder(tmp_path / "frames"))
    assert main(["pick", frames, "--edit", str(path)]) == 1
    assert sentence in capsys.readouterr().err
    assert path.read_text() == text


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node.js is installed")
def test_the_script_takes_moves_and_writes_what_a_file_has():
    """The script's model alone; the page around it is tried in Chromium."""
    script = f"""
      const m = require("{Path(pick.__file__).with_name("pick.js")}"), is = require("assert");
      const all = {json.dumps(ALL)}, items = m.items_of(all);
      is.deepEqual(m.content_of(items), all);
      is.equal(m.problem(items), "");
      const [van, , exit, queue, , post] = items;
      const grabbed = (x, y) => m.grab(items, [x, y], 2);
      is.equal(grabbed(20, 26), null);                       // inside a box, away from its edges
      is.equal(grabbed(18, 20).item, van);
      is.equal(grabbed(8, 5).item, post);
      const corner = grabbed(26, 32.5);                      // the lower right one
      m.move(corner, van.points, [4, 1.5]);
      m.move({{item: exit, handle: null}}, exit.points, [-5, 2]);
      m.move(grabbed(90, 30), queue.points, [0, 10.04]);
      const made = m.content_of(items);
      is.deepEqual(made.targets[0].box, [10, 20.5, 20, 13.5]);
      is.deepEqual([made.lines.exit.from, made.lines.exit.to], [[-5, 42], [85, 42]]);
      is.deepEqual(made.zones.queue, [[0, 0], [90, 0], [90, 40]]);
      items.push(m.new_item("zones", [[1, 1], [2, 1], [2, 2]], 3, items));
      is.equal(m.problem([...items, {{...queue}}]), "Two are named queue.");
      items.push(m.new_item("zones", [[1, 1], [2, 1], [2, 2]], 3, items));
      is.deepEqual(items.slice(-2).map(one => one.name), ["zone 1", "zone 2"]);
      items.push(m.new_item("pairs", [[1, 1]], 3, items));
      is.equal(m.problem(items), "A point of the road has no x or y.");
    """
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_grid_has_lines_where_its_labels_say(tmp_path):
    folder, path = frame_folder(tmp_path / "frames"), tmp_path / "grid.png"
    assert main(["pick", str(folder), "--grid", str(path), "--frame", "2"]) == 0
    picture = cv2.imread(str(path))[:, :, ::-1]
    assert picture.shape == (64, 96, 3)
    assert (picture[-3, 80] == (255, 240, 80)).all()
    assert (picture[-3, 82] != (255, 240, 80)).any()


def test_a_frame_that_is_not_there_is_named(tmp_path, capsys):
    folder = str(frame_folder(tmp_path / "frames"))
    assert main(["pick", folder, "--grid", str(tmp_path / "g.png"), "--frame", "99"]) == 1
    assert f"there is no frame 99; the source has {COUNT}" in capsys.readouterr().err
