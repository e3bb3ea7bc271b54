# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page of a run that goes on."""

import json
import socket
import threading
import time
from contextlib import closing, contextmanager
from urllib.error import HTTPError
from urllib.request import ProxyHandler, build_opener

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.showing.page_server import LivePage

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
