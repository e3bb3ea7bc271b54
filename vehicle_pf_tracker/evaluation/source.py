"""A recording as the plan of an evaluation names it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Source:
    """A recording of the plan.

    Attributes
    ----------
    name : str
        Its name in all tables, and of its folders.
    path : str
        Path or URL.
    topic : str
        The image topic.
    frames, width, height : int
        How many images it has, and their size in px.
    digest : str
        SHA-256 of its content.
    """

    name: str
    path: str
    topic: str
    frames: int
    width: int
    height: int
    digest: str

    @classmethod
    def from_json(cls, entry: Mapping[str, Any]) -> Source:
        """Read what `to_json` gave.

        Raises
        ------
        KeyError, TypeError, ValueError
            If it is something else.
        """
        return cls(
            name=str(entry["name"]),
            path=str(entry["path"]),
            topic=str(entry["topic"]),
            frames=int(entry["frames"]),
            width=int(entry["width"]),
            height=int(entry["height"]),
            digest=str(entry["digest"]),
        )

    def to_json(self) -> dict[str, Any]:
        """Everything as plain values."""
        return asdict(self)
