# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mistakes that a user can correct: their exception, unreadable files, suggestions for names."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from vehicle_pf_tracker.core.addresses import without_passwords

# A value in an error is cut to 80 letters: it may be a whole file.
_BRIEF = reprlib.Repr()
_BRIEF.maxstring = _BRIEF.maxother = _BRIEF.maxlong = 80


class InputError(ValueError):
    """User's mistake, described in one sentence that names the thing and the remedy.

    Raised by every room for bad files, targets, parameters and names. The command line prints the
    sentence on one line and ends with status 1; the node logs it and lives on. Passwords in
    addresses are left out of it.
    """

    def __init__(self, sentence: str = "") -> None:
        super().__init__(without_passwords(sentence))


def brief(value: object) -> str:
    """Write a value that came from outside for an error, however long it is."""
    return _BRIEF.repr(value)


def read_text(path: Path, what: str) -> str:
    """Read a file of text; `what` names it in errors, as ``the truth``.

    Raises
    ------
    InputError
        If it cannot be read, or is not text.
    """
    if path.exists() and not path.is_file():
        raise InputError(f"{what} {path} is not a regular file")
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read {what} {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{what} {path} is not text: {error}") from error


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return the known name that a mistyped one is like, in brackets; empty if there is none.

    Of dotted names the last part counts where no whole name is like it: ``sigm`` may be meant for
    ``motion.sigma``.
    """
    names = list(known)
    by_case = {one.lower(): one for one in reversed(names)}
    close = [by_case[like] for like in get_close_matches(name.lower(), by_case, n=1)]
    if not close:
        by_part = {one.rpartition(".")[2]: one for one in reversed(names)}
        close = [by_part[part] for part in get_close_matches(name.rpartition(".")[2], by_part, n=1)]
    return f" (did you mean {close[0]!r}?)" if close else ""
