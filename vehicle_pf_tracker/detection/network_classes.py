# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Names of a network's classes: from a parameter, from its file, or those of COCO."""

from __future__ import annotations

import ast
from collections.abc import Mapping

from vehicle_pf_tracker.core.errors import InputError, suggestion

_COCO_NAMES = (
    "person, bicycle, car, motorcycle, airplane, bus, train, truck, boat, traffic light, fire "
    "hydrant, stop sign, parking meter, bench, bird, cat, dog, horse, sheep, cow, elephant, "
    "bear, zebra, giraffe, backpack, umbrella, handbag, tie, suitcase, frisbee, skis, "
    "snowboard, sports ball, kite, baseball bat, baseball glove, skateboard, surfboard, tennis "
    "racket, bottle, wine glass, cup, fork, knife, spoon, bowl, banana, apple, sandwich, "
    "orange, broccoli, carrot, hot dog, pizza, donut, cake, chair, couch, potted plant, bed, "
    "dining table, toilet, tv, laptop, mouse, remote, keyboard, cell phone, microwave, oven, "
    "toaster, sink, refrigerator, book, clock, vase, scissors, teddy bear, hair drier, "
    "toothbrush"
)
COCO = tuple(_COCO_NAMES.split(", "))
"""The 80 classes of COCO, as YOLO numbers them from 0."""

_UNUSED = frozenset({12, 26, 29, 30, 45, 66, 68, 69, 71, 83})
"""Numbers of COCO's own list, from 1 to 90, that no class has."""


def numbered(names: tuple[str, ...]) -> dict[int, str]:
    """Give classes their numbers, from 0."""
    return dict(enumerate(names))


def coco_from_one() -> dict[int, str]:
    """Return COCO's classes as its own files and SSD number them, from 1 with gaps."""
    numbers = (number for number in range(1, 91) if number not in _UNUSED)
    return dict(zip(numbers, COCO, strict=True))


def parse_metadata(text: str) -> dict[int, str]:
    """Read names as exporters write them into the file, ``{0: 'person', 1: …}``; else none."""
    try:
        # Text from a file that may be anybody's: literals are read, nothing is evaluated.
        found = ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return {}
    # The order of a list is its numbers.
    if isinstance(found, list | tuple):
        found = dict(enumerate(found))
    if not isinstance(found, dict):
        return {}
    try:
        return {int(number): str(name) for number, name in found.items()}
    except (TypeError, ValueError):
        return {}


def chosen(words: str, names: Mapping[int, str]) -> frozenset[int]:
    """Return the numbers of the classes in `words`, names or numbers apart by commas.

    Raises
    ------
    InputError
        If one is not among `names`.
    """
    by_name = {name: number for number, name in names.items()}
    found = set()
    for word in filter(None, (word.strip() for word in words.split(","))):
        if word in by_name:
            found.add(by_name[word])
        # Names win over numbers: a class may be called by one.
        elif word.isdecimal() and (not names or int(word) in names):
            found.add(int(word))
        else:
            raise InputError(
                f"the network has no class {word!r}{suggestion(word, by_name)}; see "
                "detector.classes and detector.names"
            )
    return frozenset(found)
