"""How far work is that consists of many runs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Progress:
    """Runs done in this call, runs that were to be done, and what is running now."""

    done: int
    total: int
    running: tuple[str, ...]


OnProgress: TypeAlias = Callable[[Progress], None]
