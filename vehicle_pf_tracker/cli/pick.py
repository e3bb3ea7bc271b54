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

"""`pick`: point at vehicles, or at points of the road, on a page that is served here."""

from __future__ import annotations

import json
import math
import secrets
import sys
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import astuple, dataclass
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from pathlib import Path
from typing import Any, Generic, TypeVar

import yaml

from vehicle_pf_tracker.cli.console import UsageError, counting
from vehicle_pf_tracker.cli.requests import OverwriteOption, SourceOptions, option, positive, switch
from vehicle_pf_tracker.cli.tracking_options import TargetOption, read_list
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.offline.drawing import draw_pixel_grid
from vehicle_pf_tracker.offline.output_files import write_picture, write_text
from vehicle_pf_tracker.offline.pictures import has_display
from vehicle_pf_tracker.parameters.road import format_pairs
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import Source, frame_at, open_source
from vehicle_pf_tracker.road.plane import Pair

PickedT = TypeVar("PickedT")

PAIR_FORM = "{pixel: [u, v], road: [x, y]}, …"
_FILES = {
    "": ("text/html; charset=utf-8", "pick.html"),
    "pick.js": ("text/javascript; charset=utf-8", "pick.js"),
}
"""Kind and file of the page and of its script, by their path."""
_LONGEST = 1 << 20
"""Bytes of an answer: ten thousand boxes, and no more memory than that for a stray request."""


@dataclass(frozen=True, slots=True)
class Tool(Generic[PickedT]):
    """A way to pick.

    Attributes
    ----------
    name : str
        Its name in `pick.js`.
    read : callable
        Reads an entry of the page's answer.
    key : str
        Name of the list in a file of what was picked, whose entries `entry` makes.
    entry : callable
        Makes an entry of that file.
    use : str
        Verb and option that read the file.
    words : callable
        Makes the words of a command.
    """

    name: str
    read: Callable[[dict[str, Any]], PickedT]
    key: str
    entry: Callable[[PickedT], dict[str, Any]]
    use: str
    words: Callable[[PickedT], str]


def _numbers(values: Any) -> list[float]:
    numbers = [float(value) for value in values]
    if not all(map(math.isfinite, numbers)):
        raise ValueError(values)
    return numbers


def _target(entry: dict[str, Any]) -> TargetOption:
    x, y, width, height = _numbers(entry["box"])
    name = "".join(
        c for c in str(entry.get("name", "")) if c.isascii() and (c.isalnum() or c in "_-")
    )
    return TargetOption(Box(x, y, width, height), name, int(entry["frame"]))


def _target_entry(target: TargetOption) -> dict[str, Any]:
    box = [round(value, 2) for value in astuple(target.box)]
    return {"name": target.name, "frame": target.frame or 1, "box": box}


def _pair(entry: dict[str, Any]) -> Pair:
    (u, v), (x, y) = _numbers(entry["pixel"]), _numbers(entry["road"])
    return Pair((u, v), (x, y))


BOXES = Tool(
    "boxes", _target, "targets", _target_entry, "run --targets",
    lambda target: f"--target {target.name}@{target.frame}:{target.box}",
)  # fmt: skip
POINTS = Tool(
    "points", _pair, "pairs", lambda pair: {"pixel": [*pair.pixel], "road": [*pair.road]},
    "road calibrate --pairs", lambda pair: f"--pair {format_pairs((pair,))}",
)  # fmt: skip


def read_pairs(path: Path) -> list[Pair]:
    """Read pixels and the points of the road that they show from a YAML file.

    Raises
    ------
    InputError
        If it cannot be read, or an entry is not a pair.
    """
    return read_list(path, POINTS.key, PAIR_FORM, _pair)


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
        self._lock = threading.Lock()
        self._is_closed = False

    def jpeg(self, number: int) -> bytes | None:
        """Return frame `number`, from 1, as a JPEG file; None if there is none that can be read."""
        with self._lock:
            while len(self._ends) <= number and not self._is_closed:
                found = next(self._frames, None)
                if found is None:
                    self.count = len(self._ends) - 1
                    return None
                coded = b"" if found.frame is None else jpeg(found.frame)
                self._file.seek(self._ends[-1])
                self._file.write(coded)
                self._ends.append(self._ends[-1] + len(coded))
            if self._is_closed:
                return None
            begin, end = self._ends[number - 1 : number + 1]
            self._file.seek(begin)
            return self._file.read(end - begin) or None

    def close(self) -> None:
        """Wait for the frame under way; no other is read, as a decoder aborts Python's exit."""
        self._is_closed = True
        with self._lock:
            self._file.close()


class PickingServer(ThreadingHTTPServer, Generic[PickedT]):
    """Serves the page to who knows its URL, and ends with the user's answer.

    Each connection has a thread: browsers open some ahead and leave them idle.

    Parameters
    ----------
    frames : FrameStore
        The frames to pick in.
    tool : Tool
        What is picked.
    first : int
        Number of the frame shown first.

    Attributes
    ----------
    base : str
        Path under which everything is; nobody else can guess it.
    url : str
        Address of the page.
    """

    daemon_threads = True
    block_on_close = False

    def __init__(self, frames: FrameStore, tool: Tool[PickedT], first: int = 1) -> None:
        super().__init__(("127.0.0.1", 0), PageHandler)
        self.frames = frames
        self.tool = tool
        self.first = first
        self._picked: Sequence[PickedT] | None = None
        self.base = f"/{secrets.token_urlsafe(16)}/"
        self.url = f"http://127.0.0.1:{self.server_port}{self.base}"

    def pick(self) -> Sequence[PickedT]:
        """Serve until the user is done; empty if they cancel."""
        self.serve_forever(poll_interval=0.1)
        return self._picked or ()

    def finish(self, answer: Sequence[PickedT]) -> None:
        """End `pick`, from another thread."""
        self._picked = answer
        self.shutdown()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Pass over browsers that hang up, as they do when another frame is asked for."""
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


def ask(source: Source, tool: Tool[PickedT], first: int) -> Sequence[PickedT]:
    """Let the user pick in the frames of `source`; empty if they cancel."""
    with closing(FrameStore(source)) as frames, PickingServer(frames, tool, first) as server:
        print(f"open {server.url} in a browser on this machine; Ctrl-C ends this", flush=True)
        if has_display():  # without one, a text browser would take the terminal
            webbrowser.open(server.url)
        return server.pick()


class PageHandler(BaseHTTPRequestHandler):
    """Answers the requests of the page."""

    server: PickingServer[Any]

    def do_GET(self) -> None:
        """Answer with the page, a frame, or what there is to know."""
        what, frames = self._asked(), self.server.frames
        if what in _FILES:
            kind, name = _FILES[what]
            self._answer(kind, resources.files(__package__).joinpath(name).read_bytes())
        elif what == "info":
            tool, first = self.server.tool.name, self.server.first
            found = {"frames": frames.count, "frame": first, "tool": tool}
            self._answer("application/json", json.dumps(found).encode())
        elif what is not None and what.startswith("frame/") and what[6:].isdecimal():
            number = int(what[6:][:9])
            self._answer("image/jpeg", frames.jpeg(number) if number else None)
        else:
            self._answer("", None)

    def do_POST(self) -> None:
        """Take the user's answer."""
        length = self.headers.get("Content-Length", "")
        if self._asked() != "done" or not length.isdecimal() or int(length) > _LONGEST:
            self._answer("", None)
            return
        try:
            entries = json.loads(self.rfile.read(int(length))) or ()
            answer = [self.server.tool.read(entry) for entry in entries]
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            self._answer("", None)
            return
        self._answer("text/plain", b"finished")
        self.server.finish(answer)

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


@dataclass(frozen=True, kw_only=True)
class Request(SourceOptions, OverwriteOption):
    """Request of `pick`."""

    frame: int = option(
        type=positive, default=1, metavar="N", help="frame to begin with (default: 1)"
    )
    output: Path | None = option(
        "-o", type=Path, metavar="FILE",
        help="write the targets to FILE, for run --targets, or the points, for road calibrate "
        "--pairs; otherwise they are printed",
    )  # fmt: skip
    road: bool = switch(
        help="pick points of the road instead, four or more, with their places in m"
    )
    grid: Path | None = option(
        type=Path, metavar="PNG",
        help="no page: write the frame with a grid labelled in px to PNG, to read boxes off",
    )  # fmt: skip


def run(request: Request) -> int:
    """Serve the page until the user is done, and print or write the targets."""
    source = open_source(request.source, topic=request.topic, fps=request.fps)
    output = request.output if request.grid is None else request.grid
    with claimed([output], [request.source], overwrite=request.overwrite):
        return _pick(request, source)


def _pick(request: Request, source: Source) -> int:
    if request.grid is not None:
        with counting("read") as progress:
            frame = frame_at(source, request.frame, progress)
        write_picture(request.grid, draw_pixel_grid(frame))
        print(f"frame {request.frame} with a grid is in {request.grid}")
        return 0
    tool: Tool[Any] = POINTS if request.road else BOXES
    picked = ask(source, tool, request.frame)
    if not picked:
        raise UsageError("nothing was picked")
    if request.output is None:
        print(" ".join(map(tool.words, picked)))
        return 0
    entries = {tool.key: [tool.entry(one) for one in picked]}
    write_text(request.output, yaml.safe_dump(entries, sort_keys=False, default_flow_style=None))
    words = f"what was picked ({len(picked)}) is in {request.output}"
    print(f"{words}; use {tool.use} {request.output}")
    return 0
