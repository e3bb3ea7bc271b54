# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Functions that show progress: the command line makes them, and long work calls them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

ShowCount: TypeAlias = Callable[[int, int | None], None]
"""Function of the number of runs or frames that are done, and of all, None if unknown."""
ShowShare: TypeAlias = Callable[[str, float | None], None]
"""Function of words about work under way, and of its share done (0 to 1), None if unknown."""


def silent(words: str, share: float | None) -> None:
    """Show no progress."""
