# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tables of variants in pages, between markers that a reader of the page does not see."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from vehicle_pf_tracker.trackers.registry import Variant

BEGIN = "<!-- variants: `make config` writes this table -->\n\n"
"""Marker before the table of variants in a page."""
END = "\n<!-- variants: end -->"
"""Marker after it."""

Column = Callable[[Variant], str]
"""Cell of a column for a variant."""

TABLES: Mapping[str, Mapping[str, Column]] = {
    "docs/choosing.md": {
        "variant": lambda variant: f"`{variant.name}`",
        "choose it for": lambda variant: variant.suits,
    },
    "docs/variants.md": {
        "variant": lambda variant: f"`{variant.name}`",
        "method": lambda variant: variant.summary,
        "node": lambda variant: f"`{variant.executable}`",
        "parameters": lambda variant: (
            f"[config/{variant.name}.yaml](../config/{variant.name}.yaml)"
        ),
    },
}
"""Columns of the table in each page, by heading."""


def markdown_table(columns: Mapping[str, Column], variants: Iterable[Variant]) -> str:
    """Write a table with one row per variant."""
    rows = [[column(variant) for column in columns.values()] for variant in variants]
    lines = [list(columns), ["---"] * len(columns), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def replace_table(text: str, table: str) -> str:
    """Put `table` between the markers in `text`.

    Raises
    ------
    ValueError
        If the markers are not there.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"the page has no pair of markers {BEGIN.strip()!r} and {END.strip()!r}")
    return before + begin + table + end + after
