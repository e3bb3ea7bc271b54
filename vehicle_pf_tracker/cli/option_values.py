# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values of options, read from the words of a command line."""

from __future__ import annotations

import functools
import math
from collections.abc import Collection

from vehicle_pf_tracker.core.errors import InputError, suggestion


class NameChoices(tuple[str, ...]):
    """Choices that a shell completes; other names are left to the verb, which says more of them."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        """Let argparse take every name."""
        return True


def names_in(text: str, known: Collection[str], what: str) -> tuple[str, ...]:
    """Read names apart by commas, each of which has to be among the known ones."""
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in known:
            choice = f"{suggestion(name, known)}; choose from {', '.join(sorted(known))}"
            raise InputError(f"{name!r} is not {what}{choice}")
    return names


def _at_least(least: int, text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise InputError(f"{text!r} is not an integer >= {least}")
    return int(text)


positive = functools.partial(_at_least, 1)
"""Read an integer >= 1."""
natural = functools.partial(_at_least, 0)
"""Read an integer >= 0."""


def positive_number(text: str) -> float:
    """Read a finite number above 0."""
    value = number(text)
    if value <= 0:
        raise InputError(f"{text} is not more than 0")
    return value


def number(text: str) -> float:
    """Read a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{text!r} is not a number")
    return value
