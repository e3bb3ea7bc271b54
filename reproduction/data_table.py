"""Tables of an experiment: every digit for programs, rounded for the eye."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import TypeAlias

Entry: TypeAlias = float | int | str | None


@dataclass(frozen=True, slots=True)
class DataTable:
    """Columns and rows."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Entry, ...], ...]

    def to_csv(self) -> str:
        """Keep every digit, and put nothing where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        return text.getvalue()

    def to_markdown(self, decimals: int = 1) -> str:
        """Round for the eye, the first column to the left and numbers to the right."""
        rules = ["---", *("---:" for _ in self.columns[1:])]
        rows = [[_shown(entry, decimals) for entry in row] for row in self.rows]
        lines = [list(self.columns), rules, *rows]
        return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _shown(entry: Entry, decimals: int) -> str:
    if entry is None:
        return "–"
    return f"{entry:.{decimals}f}" if isinstance(entry, float) else str(entry)
