# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages of this machine's own, served to who knows their address."""

from __future__ import annotations

import json
import secrets
import socket
import sys
import threading
import time
from abc import abstractmethod
from collections.abc import Callable, Mapping
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import jpeg

PAGE = "the live page"
"""What a message calls it."""
Content = tuple[str, bytes]
"""Media type and bytes of an answer."""


_STRANGER_SECONDS = 10.0
"""Time that a connection has to ask under the secret path, s: browsers open some ahead, and open
others when these are closed."""
_MOST_STRANGERS = 64
"""Connections that have not asked under the secret path yet, which cost a thread each."""


class PageServer(ThreadingHTTPServer):
    """Serves a page to this machine, under a path that nobody can guess.

    Each connection has a thread: browsers open some ahead and leave them idle. One that does not
    ask under the path in time is closed.

    Parameters
    ----------
    handler : type of PageHandler
        Answers the requests.
    port : int
        Port; 0 takes a free one.

    Attributes
    ----------
    base : str
        The path under which everything is.
    url : str
        Address of the page.

    Raises
    ------
    InputError
        If the port cannot be had.
    """

    daemon_threads = True
    block_on_close = False

    def __init__(self, handler: type[PageHandler], port: int = 0) -> None:
        try:
            super().__init__(("127.0.0.1", port), handler)
        except OSError as error:
            raise InputError(f"cannot serve at port {port}: {error.strerror}") from None
        self._strangers: dict[Any, float] = {}
        self._lock = threading.Lock()
        self.base = f"/{secrets.token_urlsafe(16)}/"
        self.url = f"http://127.0.0.1:{self.server_port}{self.base}"

    @abstractmethod
    def content(self, what: str) -> Content | None:
        """Return what is at a path below `base`; None where there is nothing."""

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Take a connection, unless too many wait that have not asked for anything yet."""
        with self._lock:
            if len(self._strangers) >= _MOST_STRANGERS:
                return False
            self._strangers[request] = time.monotonic() + _STRANGER_SECONDS
        return True

    def admit(self, request: Any) -> None:
        """Let a connection that knows the path take its time."""
        with self._lock:
            self._strangers.pop(request, None)

    def shutdown_request(self, request: Any) -> None:
        """Close a connection."""
        self.admit(request)
        super().shutdown_request(request)

    def service_actions(self) -> None:
        """Close the connections whose time is over; called several times per s."""
        now = time.monotonic()
        with self._lock:
            late = [request for request, until in self._strangers.items() if until < now]
        for request in late:
            with suppress(OSError):  # its thread closes it at this moment
                request.shutdown(socket.SHUT_RDWR)
            self.admit(request)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Pass over browsers that hang up, as they do when another frame is asked for."""
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


class PageHandler(BaseHTTPRequestHandler):
    """Answers the requests of a page."""

    server: PageServer

    def do_GET(self) -> None:
        """Answer with what the server has under this path."""
        what = self.asked()
        self.answer(None if what is None else self.server.content(what))

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base's name
        """Say nothing: the terminal is the user's."""

    def asked(self) -> str | None:
        """Return the path below the secret one; None for all others."""
        base = self.server.base
        if not self.path.startswith(base):
            return None
        self.server.admit(self.connection)
        return self.path[len(base) :]

    def answer(self, content: Content | None, status: HTTPStatus = HTTPStatus.OK) -> None:
        """Send content; None is not found."""
        if content is None:
            self.send_error(HTTPStatus.NOT_FOUND)
            return
        self.send_response(status)
        self.send_header("Content-Type", content[0])
        self.send_header("Content-Length", str(len(content[1])))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(content[1])


_SECONDS = 2.0
"""Longest wait for the next image, after which the one before is shown: cameras of less than one
image per s are shown late."""


class LivePage(PageServer):
    """Serves the latest picture, which is drawn only when it is asked for, until it is closed.

    Parameters
    ----------
    port : int
        Port; 0 takes a free one.

    Raises
    ------
    InputError
        If the port cannot be had.
    """

    def __init__(self, port: int) -> None:
        super().__init__(PageHandler, port)
        self._shown = threading.Condition()
        self._is_wanted = False
        self._picture, self._facts = b"", b"{}"
        threading.Thread(target=self.serve_forever, args=[0.1], daemon=True).start()

    def close(self) -> None:
        """Serve no more."""
        self.shutdown()
        self.server_close()

    def show(self, draw: Callable[[], Frame], facts: Callable[[], Mapping[str, object]]) -> None:
        """Take the next image: what draws it, and what tells the numbers beside it."""
        with self._shown:
            if self._is_wanted:
                self._is_wanted = False
                self._picture, self._facts = jpeg(draw()), json.dumps(facts()).encode()
                self._shown.notify_all()

    def content(self, what: str) -> Content | None:
        """Return the page, the next picture, or the numbers of the last one."""
        if what == "":
            page = resources.files(__package__).joinpath("live.html")
            return "text/html; charset=utf-8", page.read_bytes()
        if what == "counts.json":
            return "application/json", self._facts
        if what.partition("?")[0] != "picture.jpg":
            return None
        with self._shown:
            self._is_wanted = True
            self._shown.wait(_SECONDS)
            return ("image/jpeg", self._picture) if self._picture else None
