# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page of a run that goes on."""

import json
import re
import socket
import threading
import time
from contextlib import ExitStack, closing, contextmanager, suppress
from urllib.error import HTTPError
from urllib.request import ProxyHandler, build_opener

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.showing.live_page import LivePage

GREY = np.full((48, 64, 3), 120, np.uint8)
get = build_opener(ProxyHandler({})).open  # from this machine, whatever proxy there is


@contextmanager
def images(page):
    """A camera that shows images meanwhile; yields the numbers of those that were drawn."""
    drawn, ended = [], threading.Event()

    def camera():
        for number in range(10_000):
            page.show(lambda: drawn.append(1) or GREY, lambda number=number: {"vehicles": number})
            time.sleep(0.001)
            if ended.is_set():
                return

    thread = threading.Thread(target=camera)
    thread.start()
    yield drawn
    ended.set()
    thread.join()


def test_a_picture_is_drawn_for_who_asks_and_shown_with_its_numbers():
    with closing(LivePage(0)) as page, images(page) as drawn:
        assert b"picture.jpg" in get(page.url).read()
        assert drawn == []  # nobody has asked for a picture yet
        for count in (1, 2, 3):
            coded = get(f"{page.url}picture.jpg?{count}").read()
            picture = cv2.imdecode(np.frombuffer(coded, np.uint8), cv2.IMREAD_COLOR)
            assert np.abs(picture.astype(int) - GREY).max() < 5
            assert len(drawn) == count
        assert json.loads(get(f"{page.url}counts.json").read())["vehicles"] > 0


def test_the_last_picture_stays_when_the_camera_has_stopped():
    with closing(LivePage(0)) as page:
        with pytest.raises(HTTPError, match="404"):
            get(f"{page.url}picture.jpg")
        with images(page):
            first = get(f"{page.url}picture.jpg").read()
        assert get(f"{page.url}picture.jpg").read() == first


def test_nobody_finds_the_page_without_its_address():
    with closing(LivePage(0)) as page, pytest.raises(HTTPError, match="404"):
        get(page.url.replace(page.base, "/"))


def test_a_port_that_is_taken_is_one_sentence():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(InputError, match=f"cannot serve at port {port}: "):
            LivePage(port)


def connection(page):
    return closing(socket.create_connection(("127.0.0.1", page.server_port), timeout=20))


@pytest.mark.parametrize(
    "drip", [b"", b"GET / HT", b"GET /x HTTP/1.1\r\nHost: a\r\n"], ids=["silent", "begun", "slow"]
)
def test_a_connection_that_does_not_ask_for_the_page_is_closed(monkeypatch, drip):
    monkeypatch.setattr(LivePage, "stranger_seconds", 0.5)
    with closing(LivePage(0)) as page, connection(page) as stranger:
        began = time.monotonic()
        with suppress(OSError):
            while time.monotonic() - began < 15:
                stranger.sendall(drip[:1] or b"")
                drip = drip[1:] or drip  # one byte at a time keeps no connection open
                stranger.settimeout(0.1)
                with suppress(TimeoutError):
                    if stranger.recv(100) == b"":
                        break
        assert time.monotonic() - began < 10


def test_strangers_leave_the_page_to_its_user(monkeypatch):
    monkeypatch.setattr(LivePage, "most_strangers", 4)
    monkeypatch.setattr(LivePage, "stranger_seconds", 0.5)
    with closing(LivePage(0)) as page, ExitStack() as strangers:
        for _ in range(12):
            strangers.enter_context(connection(page))
        until = time.monotonic() + 20
        while True:
            try:
                assert b"picture.jpg" in get(page.url).read()
                break
            except OSError:
                assert time.monotonic() < until
                time.sleep(0.1)
    assert threading.active_count() < 12


def test_who_knows_the_address_may_take_longer(monkeypatch):
    monkeypatch.setattr(LivePage, "stranger_seconds", 0.3)
    monkeypatch.setattr(LivePage, "picture_seconds", 1.5)
    with closing(LivePage(0)) as page, pytest.raises(HTTPError, match="404"):
        get(f"{page.url}picture.jpg")  # waits for a picture that does not come


def test_who_looks_on_is_shown_the_last_picture_and_that_the_run_has_ended():
    page, answers = LivePage(0), []

    def browse():
        while not (answers and answers[-1]["ended"]):
            get(f"{page.url}picture.jpg").read()
            answers.append(json.loads(get(f"{page.url}counts.json").read()))

    browser = threading.Thread(target=browse)
    browser.start()
    last = np.full((48, 64, 3), 250, np.uint8)
    for number in range(50):
        page.show(lambda: GREY, lambda number=number: {"vehicles": number})
        time.sleep(0.005)
    page.show(lambda: last, lambda: {"vehicles": 99})
    page.close()
    browser.join(10)
    assert not browser.is_alive()
    assert answers[-1] == {"vehicles": 99, "ended": True}


def test_a_page_that_nobody_looks_at_ends_at_once():
    page = LivePage(0)
    page.show(lambda: GREY, dict)
    began = time.monotonic()
    page.close()
    assert time.monotonic() - began < 1.5


@pytest.mark.parametrize(
    ("host", "shown"), [("127.0.0.1", "127.0.0.1"), ("0.0.0.0", None), ("::1", "[::1]")]
)
def test_a_page_may_be_served_elsewhere_under_a_word_of_ones_own(host, shown):
    try:
        page = LivePage(0, host, "a-word-of-mine")
    except InputError:
        pytest.skip(f"there is no {host} here")
    with closing(page):
        name = shown or socket.gethostname()
        assert page.url == f"http://{name}:{page.server_port}/a-word-of-mine/"
        local = f"http://{shown or '127.0.0.1'}:{page.server_port}"
        assert b"picture.jpg" in get(f"{local}/a-word-of-mine/").read()
        with pytest.raises(HTTPError, match="404"):
            get(f"{local}/")


def test_chromium_shows_picture_and_tables(browse):
    table = {
        "title": "lines",
        "columns": ["line", "counted"],
        "rows": [["gate", 12], ["exit", None]],
    }
    facts = {"summary": "0:03.0, frame 75, 2 vehicles in view", "tables": [table]}
    page, ended = LivePage(0), threading.Event()

    def camera():
        while not ended.wait(0.01):
            page.show(lambda: GREY, lambda: facts)

    with closing(page):
        thread = threading.Thread(target=camera)
        thread.start()
        # A busy machine may take the browser's whole time for its first picture.
        shown = next((dom for _ in range(4) if "0:03.0" in (dom := browse(page.url))), "")
        ended.set()
        thread.join()
    assert "0:03.0, frame 75, 2 vehicles in view" in shown
    assert "<td>gate</td><td>12</td>" in shown and "<td>exit</td><td>–</td>" in shown
    (picture,) = re.findall(r"<img[^>]*>", shown)
    assert 'src="blob:' in picture and " hidden" not in picture
