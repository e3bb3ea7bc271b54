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

"""A page on this machine alone, on which a user drags boxes over the frames of a source."""

from __future__ import annotations

import json
import secrets
import tempfile
from collections.abc import Iterator
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, HTTPServer
from importlib import resources
from typing import Any

from vehicle_pf_tracker.cli.targets import TargetOption
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.recordings.importing import jpeg
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import Source

_LONGEST = 1 << 20
"""Bytes of an answer: ten thousand boxes, and no more memory than that for a stray request."""


class FrameStore:
    """The frames of a source as JPEG files, any of them at any time.

    They are read once, as far as asked for, and kept on disk.

    Parameters
    ----------
    source : Source
        A source; of one that never ends there is the first frame only.
    """

    def __init__(self, source: Source) -> None:
        self.count = source.frame_count or 1
        self._frames: Iterator[StampedFrame] = source.frames()
        self._file = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the store
        self._ends = [0]

    def jpeg(self, number: int) -> bytes | None:
        """Return frame `number`, from 1, as a JPEG file; None if there is none that can be read."""
        while len(self._ends) <= number:
            found = next(self._frames, None)
            if found is None:
                self.count = len(self._ends) - 1
                return None
            coded = b"" if found.frame is None else jpeg(found.frame)
            self._file.seek(self._ends[-1])
            self._file.write(coded)
            self._ends.append(self._ends[-1] + len(coded))
        begin, end = self._ends[number - 1 : number + 1]
        self._file.seek(begin)
        return self._file.read(end - begin) or None


class PickingServer(HTTPServer):
    """Serves the page to who knows its URL, and ends with the user's answer.

    Parameters
    ----------
    frames : FrameStore
        The frames to pick in.
    first : int
        Number of the frame shown first.
    """

    def __init__(self, frames: FrameStore, first: int = 1) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.frames = frames
        self.first = first
        self.targets: list[TargetOption] | None = None
        self._token = secrets.token_urlsafe(16)

    @property
    def base(self) -> str:
        """Path under which everything is; nobody else can guess it."""
        return f"/{self._token}/"

    @property
    def url(self) -> str:
        """Address of the page."""
        return f"http://127.0.0.1:{self.server_port}{self.base}"

    def pick(self) -> list[TargetOption]:
        """Serve until the user is done; empty if they cancel."""
        while self.targets is None:
            self.handle_request()
        return self.targets


class _Handler(BaseHTTPRequestHandler):
    server: PickingServer

    def do_GET(self) -> None:
        """Answer with the page, a frame, or what there is to know."""
        what = self._asked()
        if what == "":
            page = resources.files(__package__).joinpath("pick.html").read_bytes()
            self._answer("text/html; charset=utf-8", page)
        elif what == "info":
            found = {"frames": self.server.frames.count, "frame": self.server.first}
            self._answer("application/json", json.dumps(found).encode())
        elif what is not None and what.startswith("frame/") and what[6:].isdecimal():
            number = int(what[6:][:9])
            coded = self.server.frames.jpeg(number) if number else None
            self._answer("image/jpeg", coded)
        else:
            self._answer("", None)

    def do_POST(self) -> None:
        """Take the boxes."""
        length = self.headers.get("Content-Length", "")
        if self._asked() != "done" or not length.isdecimal() or int(length) > _LONGEST:
            self._answer("", None)
            return
        try:
            self.server.targets = [_target(one) for one in json.loads(self.rfile.read(int(length)))]
        except (ValueError, KeyError, TypeError, RecursionError):
            self._answer("", None)
            return
        self._answer("text/plain", b"finished")

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base's name
        """Say nothing: the terminal is the user's."""

    def _asked(self) -> str | None:
        """Return the path below the secret one; None for all others."""
        base = self.server.base
        return self.path[len(base) :] if self.path.startswith(base) else None

    def _answer(self, kind: str, content: bytes | None) -> None:
        if content is None:
            self.send_error(HTTPStatus.NOT_FOUND)
            return
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(content)


def _target(entry: dict[str, Any]) -> TargetOption:
    x, y, width, height = map(float, entry["box"])
    box = Box(x, y, width, height)
    name = "".join(
        c for c in str(entry.get("name", "")) if c.isascii() and (c.isalnum() or c in "_-")
    )
    return TargetOption(box, name, int(entry["frame"]))
