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

"""A page that shows a run while it goes on: the picture with all vehicles, and the counts."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Mapping
from importlib import resources

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.offline.page_server import Content, PageHandler, PageServer

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
