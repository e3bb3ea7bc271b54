"""How much memory things keep."""

from __future__ import annotations

from typing import NamedTuple


class MemoryCase(NamedTuple):
    """Resident memory of ours and of what it is compared with, in MB."""

    name: str
    ours_mb: float
    peer_mb: float
