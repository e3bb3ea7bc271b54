# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shapes drawn with `pick`: sections of a file, each checked by the reader of its verb."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeAlias

from vehicle_pf_tracker.cli.target_options import TARGET_FORM, list_in, target_of
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.counting_plan import parse_counting_plan
from vehicle_pf_tracker.parameters.road import format_pairs
from vehicle_pf_tracker.road.plane import Pair

Document: TypeAlias = dict[str, Any]
"""Drawn shapes by section, as in a file of `pick`."""

PAIR_FORM = "{pixel: [u, v], road: [x, y]}, …"
"""Form of the entries of `PAIRS_SECTION`, for errors."""
TARGETS_SECTION = "targets"
"""Section of the boxes that vehicles are in at first."""
PAIRS_SECTION = "pairs"
"""Section of pixels with the points of the road that they show."""
SECTION_USES: Mapping[str, str] = {
    TARGETS_SECTION: "run --targets",
    **dict.fromkeys(("lines", "zones", "roi"), "traffic --lines"),
    PAIRS_SECTION: "road calibrate --pairs",
}
"""Verb and option that read a section of the file."""


def pair_of(entry: Mapping[str, Any]) -> Pair:
    """Read a pixel and the point of the road that it shows, as `PAIR_FORM` has them."""
    (u, v), (x, y) = (map(float, entry[key]) for key in ("pixel", "road"))
    if not all(map(math.isfinite, (u, v, x, y))):
        raise ValueError(entry)
    return Pair((u, v), (x, y))


def checked(document: Any, where: str) -> Document:
    """Return the sections that are not empty, each checked by the reader of the verb that uses it.

    Raises
    ------
    InputError
        If one cannot be used.
    """
    if not isinstance(document, dict) or not set(document) <= set(SECTION_USES):
        raise InputError(f"{where} has other sections than {', '.join(SECTION_USES)}")
    sections = {key: body for key, body in document.items() if body}
    for key, form, read in (
        (TARGETS_SECTION, TARGET_FORM, target_of),
        (PAIRS_SECTION, PAIR_FORM, pair_of),
    ):
        if key in sections:
            list_in(sections, where, key, form, read)
    plan = {
        key: body for key, body in sections.items() if key not in {TARGETS_SECTION, PAIRS_SECTION}
    }
    if plan:
        try:
            parse_counting_plan(plan)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
    return sections


def words_of(document: Document) -> str:
    """Write targets and pairs as words of a command."""
    words = [
        f"--target {target.name}@{target.frame}:{target.box}"
        for target in map(target_of, document.get(TARGETS_SECTION, ()))
    ]
    pairs = [
        f"--pair {format_pairs((pair,))}" for pair in map(pair_of, document.get(PAIRS_SECTION, ()))
    ]
    return " ".join([*words, *pairs])
