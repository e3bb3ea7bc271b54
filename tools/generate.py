# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files that follow from the registry and the parameter tables: `make config` writes them.

These are config/ (parameter files and the SROS 2 policy), docs/parameters.md, the picture of the
rooms in docs/images/rooms.svg, and the tables of variants between the markers in docs/choosing.md
and docs/variants.md.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from tools import rooms
from tools.parameters_page import parameters_page
from tools.rooms_picture import picture
from tools.sros2_policy import policy
from vehicle_pf_tracker.cli.params import default_yaml
from vehicle_pf_tracker.ros.transport import LAUNCHED_SEGMENT, profile
from vehicle_pf_tracker.trackers.registry import NODES, VARIANTS, Variant

ROOT = Path(__file__).resolve().parents[1]

BEGIN = "<!-- variants: `make config` writes this table -->\n\n"
"""Marker before the table of variants in a page, which a reader of the page does not see."""
END = "\n<!-- variants: end -->"
"""Marker after it."""

Column = Callable[[Variant], str]

_NAME: Column = lambda variant: f"`{variant.name}`"  # noqa: E731 - a column is one expression
_SUMMARY: Column = lambda variant: variant.summary  # noqa: E731

TABLES: Mapping[str, Mapping[str, Column]] = {
    "docs/choosing.md": {"variant": _NAME, "choose it for": lambda variant: variant.suits},
    "docs/variants.md": {
        "variant": _NAME,
        "method": _SUMMARY,
        "node": lambda variant: f"`{variant.executable}`",
        "parameters": lambda variant: (
            f"[config/{variant.name}.yaml](../config/{variant.name}.yaml)"
        ),
    },
}
"""Columns of the table of variants in each page, by heading."""


def generated_files(root: Path = ROOT) -> dict[Path, str]:
    """Return the text of every generated file; pages keep what stands outside the markers."""
    variants = VARIANTS.values()
    nodes = NODES.values()
    files = {root / "config" / f"{node.name}.yaml": default_yaml(node) for node in nodes}
    files[root / "config" / "sros2_policy.xml"] = policy(nodes)
    files[root / "config" / "large_images.xml"] = profile(LAUNCHED_SEGMENT)
    files[root / "docs" / "parameters.md"] = parameters_page()
    for page, columns in TABLES.items():
        text = (root / page).read_text(encoding="utf-8")
        files[root / page] = replace_table(text, markdown_table(columns, variants))
    graph = rooms.reduced(rooms.rooms_graph(root / rooms.PACKAGE))
    files[root / "docs" / "images" / "rooms.svg"] = picture(graph)
    return files


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


def main() -> int:
    """Write the files that are not up to date, and delete parameter files of no variant."""
    files = generated_files()
    for path in sorted((ROOT / "config").glob("*.yaml")):
        if path not in files:
            path.unlink()
            print(f"deleted {path.relative_to(ROOT)}")
    for path, text in files.items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(f"wrote {path.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
