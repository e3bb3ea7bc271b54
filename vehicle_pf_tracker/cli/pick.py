# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`pick`: draw vehicles, lines, zones, regions and points of the road on a page served here."""

from __future__ import annotations

import json
import math
import os
import tempfile
import threading
import webbrowser
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from http import HTTPStatus
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from vehicle_pf_tracker.cli.console import UsageError, counting
from vehicle_pf_tracker.cli.requests import OverwriteOption, SourceOptions, option, positive, switch
from vehicle_pf_tracker.cli.target_options import TARGET_FORM, list_in, target_of
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.parameters.counting_plan import parse_counting_plan
from vehicle_pf_tracker.parameters.files import read_yaml_file
from vehicle_pf_tracker.parameters.road import format_pairs
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import ImageSource, frame_at
from vehicle_pf_tracker.results.output_files import write_picture, write_text
from vehicle_pf_tracker.road.plane import Pair
from vehicle_pf_tracker.showing.grids import draw_pixel_grid
from vehicle_pf_tracker.showing.page_server import Content, PageHandler, PageServer

Document: TypeAlias = dict[str, Any]
"""Drawn shapes by section, as in a file of `pick`."""

PAIR_FORM = "{pixel: [u, v], road: [x, y]}, …"
"""Form of the entries of `PAIRS`, for errors."""
TARGETS = "targets"
"""Section of the boxes that vehicles are in at first."""
PAIRS = "pairs"
"""Section of pixels with the points of the road that they show."""
USES: Mapping[str, str] = {
    TARGETS: "run --targets",
    **dict.fromkeys(("lines", "zones", "roi"), "traffic --lines"),
    PAIRS: "road calibrate --pairs",
}
"""Verb and option that read a section of the file."""
_TEXT = "text/plain; charset=utf-8"
"""Type of answers to the page: the words that it shows."""
_LONGEST = 1 << 20
"""Bytes of an answer: ten thousand boxes, and no more memory than that for a stray request."""


def pair_of(entry: Mapping[str, Any]) -> Pair:
    """Read a pixel and the point of the road that it shows, as `PAIR_FORM` has them."""
    (u, v), (x, y) = (map(float, entry[key]) for key in ("pixel", "road"))
    if not all(map(math.isfinite, (u, v, x, y))):
        raise ValueError(entry)
    return Pair((u, v), (x, y))


def checked(document: Any, where: str) -> Document:
    """Return the sections that hold something, after they were read as their users read them.

    Raises
    ------
    InputError
        If one cannot be used.
    """
    if not isinstance(document, dict) or not set(document) <= set(USES):
        raise InputError(f"{where} has other sections than {', '.join(USES)}")
    found = {key: body for key, body in document.items() if body}
    for key, form, read in ((TARGETS, TARGET_FORM, target_of), (PAIRS, PAIR_FORM, pair_of)):
        if key in found:
            list_in(found, where, key, form, read)
    plan = {key: body for key, body in found.items() if key not in {TARGETS, PAIRS}}
    if plan:
        try:
            parse_counting_plan(plan)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
    return found


class FrameStore:
    """The frames of a source as JPEG files, any of them at any time.

    They are read once, as far as asked for, and kept on disk.

    Parameters
    ----------
    source : ImageSource
        A source; of one that never ends there is the first frame only.
    """

    def __init__(self, source: ImageSource) -> None:
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


class Editor(PageServer):
    """Serves the page on which the user draws, and ends with what they drew.

    Parameters
    ----------
    frames : FrameStore
        The frames to draw in.
    sections : sequence of str
        What can be drawn, of `USES`; the first is offered first.
    first : int
        Number of the frame shown first.
    document : dict
        What is there to be edited.

    Attributes
    ----------
    drawn : dict
        What the user drew; empty if they cancelled.
    """

    def __init__(
        self, frames: FrameStore, sections: Sequence[str], first: int, document: Document
    ) -> None:
        super().__init__(_Handler)
        self._frames = frames
        self._facts = {"frame": first, "sections": sections, "document": document}
        self.drawn: Document = {}

    def content(self, what: str) -> Content | None:
        """Return the page, a frame, or what there is to know."""
        if what in {"", "pick.js"}:
            kind = f"text/{'javascript' if what else 'html'}; charset=utf-8"
            return kind, resources.files(__package__).joinpath(what or "pick.html").read_bytes()
        if what == "info":
            facts = {**self._facts, "frames": self._frames.count}
            return "application/json", json.dumps(facts, default=str).encode()
        if not what.startswith("frame/") or not what[6:].isdecimal():
            return None
        number = int(what[6:][:9])
        coded = self._frames.jpeg(number) if number else None
        return None if coded is None else ("image/jpeg", coded)


class _Handler(PageHandler):
    server: Editor

    def do_POST(self) -> None:  # noqa: N802 - the base's name
        length = self.headers.get("Content-Length", "")
        if self.asked() != "done" or not length.isdecimal() or int(length) > _LONGEST:
            self.answer(None)
            return
        try:
            document = json.loads(self.rfile.read(int(length)))
            self.server.drawn = checked(document or {}, "what was drawn")
        except (ValueError, RecursionError) as error:  # no JSON, or nothing that can be used
            self.answer((_TEXT, str(error).encode()), HTTPStatus.BAD_REQUEST)
            return
        self.answer((_TEXT, b"finished"))
        self.server.shutdown()


def ask(
    source: ImageSource, sections: Sequence[str], first: int, document: Document | None = None
) -> Document:
    """Let the user draw in the frames of `source`, over what is there already.

    Raises
    ------
    UsageError
        If nothing is drawn, or they cancel.
    """
    with (
        closing(FrameStore(source)) as frames,
        Editor(frames, sections, first, document or {}) as editor,
    ):
        print(f"open {editor.url} in a browser on this machine; Ctrl-C ends this", flush=True)
        if has_display():  # without one, a text browser would take the terminal
            webbrowser.open(editor.url)
        editor.serve_forever(poll_interval=0.1)
    if not editor.drawn:
        raise UsageError("nothing was picked")
    return editor.drawn


def has_display() -> bool:
    """Return whether windows can be shown."""
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


@dataclass(frozen=True, kw_only=True)
class Request(SourceOptions, OverwriteOption):
    """Request of `pick`."""

    frame: int = option(
        type=positive, default=1, metavar="N", help="frame to begin with (default: 1)"
    )
    output: Path | None = option(
        "-o", help="file for run --targets, traffic --lines and road calibrate --pairs; without "
        "it, what was drawn is printed",
    )  # fmt: skip
    edit: Path | None = option(help="change such a file, or with -o a copy of it")
    road: bool = switch(help="only points of the road, four or more, with their x and y in metres")
    grid: Path | None = option(
        metavar="PNG",
        help="no page: write the frame with a grid labelled in px to PNG, to read boxes off",
    )  # fmt: skip


def run(request: Request) -> int:
    """Serve the page until the user is done, and print or write what was drawn."""
    source = request.open_source()
    output = request.grid or request.output or request.edit
    is_in_place = output == request.edit
    inputs = [request.source, None if is_in_place else request.edit]
    with claimed([output], inputs, overwrite=request.overwrite or is_in_place):
        if request.grid is None:
            return _draw(request, source, output)
        with counting("read") as progress:
            frame = frame_at(source, request.frame, progress)
        write_picture(request.grid, draw_pixel_grid(frame))
        print(f"frame {request.frame} with a grid is in {request.grid}")
        return 0


def _draw(request: Request, source: ImageSource, output: Path | None) -> int:
    before = None
    if request.edit is not None:
        where = f"the file {request.edit}"
        before = checked(read_yaml_file(request.edit, "file"), where)
    drawn = ask(source, (PAIRS,) if request.road else tuple(USES), request.frame, before)
    text = yaml.safe_dump(drawn, sort_keys=False, default_flow_style=None, allow_unicode=True)
    if output is None:
        print(words_of(drawn) if set(drawn) <= {TARGETS, PAIRS} else text)
        return 0
    write_text(output, text)
    uses = " and ".join(dict.fromkeys(f"{USES[key]} {output}" for key in drawn))
    print(f"what was drawn is in {output}; use {uses}")
    return 0


def words_of(document: Document) -> str:
    """Write targets and pairs as words of a command."""
    words = [
        f"--target {one.name}@{one.frame}:{one.box}"
        for one in map(target_of, document.get(TARGETS, ()))
    ]
    pairs = [f"--pair {format_pairs((pair_of(one),))}" for one in document.get(PAIRS, ())]
    return " ".join([*words, *pairs])
