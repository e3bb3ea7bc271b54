# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Server of pages on this machine, under an address that only its user knows."""

from __future__ import annotations

import secrets
import socket
import sys
import threading
import time
from abc import abstractmethod
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from vehicle_pf_tracker.core.errors import InputError

Content = tuple[str, bytes]
"""Media type and bytes of an answer."""

LOCAL_ADDRESS = "127.0.0.1"
"""Address of this machine alone."""
_EVERYWHERE = frozenset({"0.0.0.0", "::"})  # noqa: S104 - only where it is asked for
"""Addresses at which a server listens on every network."""


class PageServer(ThreadingHTTPServer):
    """Server of a page under a path that nobody can guess, to this machine unless set otherwise.

    Each connection has a thread: browsers open some ahead and leave them idle. One that does not
    ask under the path in time is closed.

    Parameters
    ----------
    handler : type of PageHandler
        Handler of the requests.
    port : int
        Port; 0 takes a free one.
    host : str
        Address to listen at; 0.0.0.0 lets other machines in, in clear text.
    token : str
        Secret part of the path; empty draws one.

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
    stranger_seconds = 10.0
    """Time that a connection has to ask under the secret path, s: browsers open some ahead, and
    open others when these are closed."""
    most_strangers = 64
    """Connections that have not asked under the secret path yet, which cost a thread each."""

    def __init__(
        self, handler: type[PageHandler], port: int = 0, host: str = LOCAL_ADDRESS, token: str = ""
    ) -> None:
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        try:
            super().__init__((host, port), handler)
        except OSError as error:
            raise InputError(f"cannot serve at port {port}: {error.strerror or error}") from None
        self._strangers: dict[Any, float] = {}
        self._lock = threading.Lock()
        self.base = f"/{token or secrets.token_urlsafe(16)}/"
        shown = socket.gethostname() if host in _EVERYWHERE else host
        name = f"[{shown}]" if ":" in shown else shown
        self.url = f"http://{name}:{self.server_port}{self.base}"

    @abstractmethod
    def content(self, what: str) -> Content | None:
        """Return what is at a path below `base`; None where there is nothing."""

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Take a connection, unless too many wait that have not asked for anything yet."""
        with self._lock:
            if len(self._strangers) >= self.most_strangers:
                return False
            self._strangers[request] = time.monotonic() + self.stranger_seconds
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
    """Handler of the requests of a page."""

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
