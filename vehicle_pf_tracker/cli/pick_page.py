# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Page of `pick`, on which a user draws in the frames of a source."""

from __future__ import annotations

import json
import os
import tempfile
import threading
import webbrowser
from collections.abc import Iterator, Sequence
from contextlib import closing
from http import HTTPStatus
from importlib import resources

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.picked_shapes import Document, checked
from vehicle_pf_tracker.image.formats.compressed_image import jpeg
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import ImageSource
from vehicle_pf_tracker.showing.page_server import Content, PageHandler, PageServer

_TEXT = "text/plain; charset=utf-8"
"""Type of answers to the page: the words that it shows."""
_LONGEST = 1 << 20
"""Bytes of an answer: ten thousand boxes, and no more memory than that for a stray request."""


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
                stamped = next(self._frames, None)
                if stamped is None:
                    self.count = len(self._ends) - 1
                    return None
                coded = b"" if stamped.frame is None else jpeg(stamped.frame)
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
    """Server of the page on which the user draws, which ends with what they drew.

    Parameters
    ----------
    frames : FrameStore
        The frames to draw in.
    sections : sequence of str
        Sections that can be drawn, of `SECTION_USES`; the first is offered first.
    first : int
        Number of the frame shown first.
    document : dict
        Shapes that are there already, to be edited.

    Attributes
    ----------
    drawn : dict
        Shapes that the user drew; empty if they cancelled.
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
