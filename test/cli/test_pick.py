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

"""`pick`: the page's server, spoken to as a browser would, and the grid."""

import json
import socket
import struct
import threading
import urllib.error
import urllib.request
from contextlib import contextmanager

import cv2
import pytest
from small_recordings import COUNT, frame_folder, frame_of, record

from vehicle_pf_tracker.cli import pick
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.pick import BOXES, FrameStore, PickingServer
from vehicle_pf_tracker.cli.tracking_options import read_targets
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import open_source

ANSWER = [
    {"name": "van 1!", "frame": 3, "box": [10, 20.5, 16, 12]},
    {"name": "", "frame": 1, "box": [1, 2, 3, 4]},
]


@pytest.fixture
def answered(monkeypatch):
    """Let a user answer with these boxes as soon as the page's address is known."""

    def use(boxes):
        def answer(url):
            request = urllib.request.Request(f"{url}done", json.dumps(boxes).encode())
            thread = threading.Thread(target=lambda: urllib.request.urlopen(request, timeout=30))
            thread.start()

        monkeypatch.setenv("DISPLAY", ":0")
        monkeypatch.setattr(pick.webbrowser, "open", answer)

    return use


@pytest.fixture
def server(tmp_path):
    """A server that answers until the test is over."""
    source = open_source(record(tmp_path / "bag"))
    with PickingServer(FrameStore(source), BOXES, first=2) as made, serving(made):
        yield made


@contextmanager
def serving(server):
    """Let `server` wait for the user's answer; give the list that it is put into."""
    picked = []
    thread = threading.Thread(target=lambda: picked.append(server.pick()))
    thread.start()
    yield picked
    if not picked:
        get(server.url + "done", b"null")
    thread.join(timeout=30)
    assert not thread.is_alive()


def get(url, body=None):
    with urllib.request.urlopen(urllib.request.Request(url, body), timeout=30) as answer:
        return answer.read()


def status(url, body=None):
    try:
        get(url, body)
    except urllib.error.HTTPError as error:
        return error.code
    return 200


def test_the_page_and_any_frame_are_served(server):
    assert b"<title>Pick targets</title>" in get(server.url)
    assert b"fetch(" in get(server.url + "pick.js")
    assert json.loads(get(server.url + "info")) == {"frames": COUNT, "frame": 2, "tool": "boxes"}
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
        ("done", b"no json"),
        ("done", b"[{}]"),
        ("done", b"[3]"),
        ("done", b"3"),
        ("done", b'[{"box": [1, 2, NaN, 4], "frame": 1}]'),
        ("done", b'[{"box": [1, 2], "frame": 1}]'),
    ],
)
def test_what_is_not_there_is_not_found(server, path, body):
    assert status(server.url + path, body) == 404
    assert status(server.url + "info") == 200  # it goes on waiting


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
    assert [(t.name, t.frame, t.box) for t in read_targets(path)] == [
        ("van1", 3, Box(10, 20.5, 16, 12)), ("", 1, Box(1, 2, 3, 4))
    ]  # fmt: skip
    words = ["--variant", "pf", "--targets", str(path), "-o", str(tmp_path / "out")]
    assert main(["run", folder, *words]) == 0
    assert "van1: WAITING 0:00.0-0:00.0, TRACKING" in capsys.readouterr().out


def test_nothing_picked_is_an_error(answered, tmp_path, capsys):
    answered([])
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
    monkeypatch.setattr(pick.webbrowser, "open", lambda url: pytest.fail("opened"))
    monkeypatch.setattr(PickingServer, "serve_forever", lambda server, poll_interval: None)
    assert main(["pick", str(record(tmp_path / "bag"))]) == 2
    assert "open http://127.0.0.1:" in capsys.readouterr().out


POINTS_OF_THE_ROAD = [
    {"pixel": [8.5, 4], "road": [0, 20.25]},
    {"pixel": [90, 4], "road": [9, 20]},
    {"pixel": [90, 60], "road": [9, 0]},
    {"pixel": [8, 60], "road": [0, 0]},
]


def test_points_of_the_road_are_printed_as_words_or_written(answered, tmp_path, capsys):
    answered(POINTS_OF_THE_ROAD)
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
    answered(POINTS_OF_THE_ROAD)
    out, grid = tmp_path / "road.yaml", tmp_path / "check.png"
    folder = str(frame_folder(tmp_path / "frames"))
    assert main(["road", "calibrate", folder, "-o", str(out), "--grid", str(grid)]) == 0
    assert "8.5,4.0=0.0,20.25; 90.0,4.0=9.0,20.0" in out.read_text()
    assert grid.exists()


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
