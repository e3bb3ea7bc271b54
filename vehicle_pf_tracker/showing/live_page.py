# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Page that shows a run while it goes on: its latest picture, and what is counted."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Mapping
from importlib import resources

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.compressed_image import jpeg
from vehicle_pf_tracker.showing.page_server import LOCAL_ADDRESS, Content, PageHandler, PageServer

PAGE_NAME = "the live page"
"""Name of the page in messages."""
_LAST_FETCH = 2.0
"""Time at the end of a run in which a browser that looks on fetches the last picture, s."""
_LOOKED_ON = 5.0
"""Time since the last question after which nobody looks on any more, s: a page asks for the next
picture at once, and a slow line takes a second or two for one."""


class LivePage(PageServer):
    """Server of the latest picture, which is drawn only when it is asked for, until it is closed.

    Parameters
    ----------
    port : int
        Port; 0 takes a free one.
    host : str
        Address to listen at.
    token : str
        Secret part of the address; empty draws one.

    Raises
    ------
    InputError
        If the port cannot be had.
    """

    picture_seconds = 2.0
    """Longest wait for the next image, s, after which the one before is sent again: so it is where
    a camera gives less than one image in two seconds."""

    def __init__(self, port: int, host: str = LOCAL_ADDRESS, token: str = "") -> None:
        super().__init__(PageHandler, port, host, token)
        self._shown = threading.Condition()
        self._is_wanted = False
        self._asked = -_LOOKED_ON
        self._has_ended = False
        self._was_told = False
        self._picture = b""
        self._facts = b"{}"
        self._latest: tuple[Callable[[], Frame], Callable[[], Mapping[str, object]]] | None = None
        threading.Thread(target=self.serve_forever, args=[0.1], daemon=True).start()

    def close(self) -> None:
        """Show the last picture and that the run has ended, and serve no more."""
        with self._shown:
            self._has_ended = True
            if self._latest is not None and self._is_watched():
                self._draw(*self._latest)
                self._shown.wait_for(lambda: self._was_told, _LAST_FETCH)
        self.shutdown()
        self.server_close()

    def show(self, draw: Callable[[], Frame], facts: Callable[[], Mapping[str, object]]) -> None:
        """Take the next image: a function that draws it, and one that gives the numbers with it."""
        with self._shown:
            self._latest = draw, facts
            if self._is_wanted:
                self._is_wanted = False
                self._draw(draw, facts)

    def _is_watched(self) -> bool:
        return time.monotonic() - self._asked < _LOOKED_ON

    def _draw(self, draw: Callable[[], Frame], facts: Callable[[], Mapping[str, object]]) -> None:
        self._picture = jpeg(draw())
        self._facts = json.dumps({**facts(), "ended": self._has_ended}).encode()
        self._shown.notify_all()

    def content(self, what: str) -> Content | None:
        """Return the page, the next picture, or the numbers of the last one."""
        if what == "":
            page = resources.files(__package__).joinpath("live.html")
            return "text/html; charset=utf-8", page.read_bytes()
        if what == "counts.json":
            with self._shown:
                if self._has_ended:
                    self._was_told = True
                    self._shown.notify_all()
                return "application/json", self._facts
        if what.partition("?")[0] != "picture.jpg":
            return None
        with self._shown:
            self._asked = time.monotonic()
            if not self._has_ended:
                self._is_wanted = True
                self._shown.wait(self.picture_seconds)
            return ("image/jpeg", self._picture) if self._picture else None
