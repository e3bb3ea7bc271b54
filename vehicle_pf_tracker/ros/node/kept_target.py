# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Box of a node's target in a file, from which a node that was killed takes it up again."""

from __future__ import annotations

import json
import time

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.formats.encodings import LARGEST_SIDE_PX
from vehicle_pf_tracker.ros.own_files import own_file, read_small, write_private

_SAVE_EVERY = 1.0
"""Time between two writings, s: a disk has few, and a vehicle moves less than its length."""
_FRESH = 30.0
"""Age in s up to which a target is taken up again: a respawn takes seconds, an operator longer."""
_CLOCK_STEP = 1.0
"""Seconds that a file may be of the future: file systems round times, some to whole seconds."""


class KeptTarget:
    """The file of one node.

    Parameters
    ----------
    name : str
        Full name of the node.
    """

    def __init__(self, name: str) -> None:
        self._path = own_file(name, "target.json")
        self._saved = 0.0

    def save(self, box: Box | None) -> None:
        """Write the box, once a second at most.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        if box is None or time.monotonic() - self._saved < _SAVE_EVERY:
            return
        # Before it is written: a full disk is tried once a second, too, and not with every image.
        self._saved = time.monotonic()
        write_private(self._path, json.dumps([box.x, box.y, box.width, box.height]))

    def load(self) -> Box | None:
        """Return the box that was written a moment ago; None where there is no file.

        Raises
        ------
        InputError
            If the file is not of the last 30 s, or holds no box that can be in an image.
        """
        try:
            text, written = read_small(self._path)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise InputError(f"{self._path}: {error.strerror or error}") from None
        # By the wall clock, as another process wrote it.
        age = time.time() - written
        if not -_CLOCK_STEP <= age <= _FRESH:
            when = f"{age:.0f} s old" if age > 0 else f"{-age:.0f} s of the future"
            raise InputError(f"{self._path} is {when}")
        try:
            box = Box(*map(float, json.loads(text)))
        except (ValueError, TypeError, ArithmeticError, RecursionError):
            raise InputError(f"{self._path} holds no box [x, y, width, height]") from None
        # Any image's size: that of the stream is not known before the first one.
        return check_target(box, LARGEST_SIDE_PX, LARGEST_SIDE_PX)
