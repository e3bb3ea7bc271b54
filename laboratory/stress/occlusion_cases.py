# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cases with painted occluders: which, of what duration, over which stretch of a sequence.

Standing occluders move with the background, and stay where they are before a camera that stands; a
sequence whose background is not one plane to the camera (see `background`) gets none. Lorries move
relative to the background, or, in such a sequence, relative to the image.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np

from laboratory.stress.background import Background, background_of
from laboratory.stress.cases import Case
from laboratory.stress.footage import StressFootage, StressSource, open_footage
from laboratory.stress.occluder import Occluder
from laboratory.stress.painting import LORRY, POLE, WALL
from laboratory.stress.placing import OcclusionSpec, Placed, Placer
from vehicle_pf_tracker.scenes.random_streams import stream

DURATIONS = (5, 10, 20, 40)
"""Totally hidden frames that are aimed at; what came out is in the case's labels."""
_CROSSINGS = {"fast": 4.0, "slow": 15.0}
"""Frames that a lorry takes to cover the vehicle: 0.13 and 0.5 s at 30 frames/s."""
_LORRIES = (("fast", 5), ("fast", 10), ("fast", 20), ("slow", 10), ("slow", 20), ("slow", 40))
"""A slow lorry that hides for 5 frames is shorter than the vehicle; a fast one for 40, a train."""
_POLES = 3
"""Posts differ in width, place and shade, and not in duration, so that a few will do."""
_ANCHORS = 32
"""Frames tried in a sequence, evenly spread: with 16, 27 turning stretches are found, not 44."""
_LARGEST_SHARE = 0.6
"""Share of the image that an occluder may cover: more is no picture of a road any more."""
_PATCH_TRIES = 12
"""Random patches that the most textured is taken of; a few are sky or empty road."""


def walls(origin: StressSource, seed: int) -> Iterator[Case]:
    """Make cases with a wall, one over a straight and one over a turning stretch of each length."""
    for duration in DURATIONS:
        yield from _cases(origin, WALL, OcclusionSpec(WALL, duration), f"{duration}", seed)


def poles(origin: StressSource, seed: int) -> Iterator[Case]:
    """Make cases with a post that hides the vehicle in part."""
    for number in range(1, _POLES + 1):
        yield from _cases(origin, POLE, OcclusionSpec(POLE), f"{number}", seed)


def lorries(origin: StressSource, seed: int) -> Iterator[Case]:
    """Make cases with a lorry that drives across."""
    for speed, duration in _LORRIES:
        spec = OcclusionSpec(LORRY, duration, _CROSSINGS[speed])
        yield from _cases(origin, LORRY, spec, f"{speed}_{duration}", seed, speed=speed)


def _cases(
    origin: StressSource, kind: str, spec: OcclusionSpec, variation: str, seed: int, **labels: str
) -> Iterator[Case]:
    footage = open_footage(origin.source)
    background = background_of(origin.source)
    size = origin.source.width, origin.source.height
    placer = Placer(footage.truth, background, size)
    # By the case's name, so that another kind or length leaves this case as it is.
    own = zlib.crc32(f"{seed}/{origin.name}/{kind}/{variation}".encode())
    done = set[str]()
    # Frames are tried until there is one case of each path, or none is left.
    for anchor in _anchors(len(footage.truth), own):
        placed = placer.place(spec, anchor, own)
        if placed is None or placed.path in done or _is_too_large(placed, footage):
            continue
        done.add(placed.path)
        occluder = _with_texture(placed, footage, own)
        more = {**labels, "path": placed.path, "hidden": str(placed.hidden)}
        more["course"] = placed.course
        more["carried_by"] = _carrier(background)
        yield Case(
            origin,
            kind,
            f"{variation}_{placed.path}",
            placed.first,
            placed.count,
            seed=own,
            labels=tuple(more.items()),
            changes=(occluder,),
        )
        if len(done) == 2:
            return


def _anchors(frames: int, seed: int) -> list[int]:
    """Frames to try, in random order."""
    frames_tried = np.unique(np.linspace(0, frames - 1, _ANCHORS + 2).round().astype(int)[1:-1])
    return [int(frame) for frame in stream(seed, "anchors").permutation(frames_tried)]


def _carrier(background: Background) -> str:
    if background.stands:
        return "standing camera"
    return "background" if background.coherent else "image"


def _is_too_large(placed: Placed, footage: StressFootage) -> bool:
    """Return whether the occluder ever covers most of the image."""
    width = footage.source.width
    height = footage.source.height
    image = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32)
    # Every fifth frame: a rectangle's share of the image changes little in between.
    for index in range(placed.first, placed.first + placed.count, 5):
        corners = placed.occluder.corners(index).astype(np.float32)
        shared, _ = cv2.intersectConvexConvex(image, corners)
        if shared > _LARGEST_SHARE * width * height:
            return True
    return False


def _with_texture(placed: Placed, footage: StressFootage, seed: int) -> Occluder:
    """Choose the most textured of a few random patches, away from the vehicle."""
    rng = stream(seed, "patch")
    occluder = placed.occluder
    source = footage.source
    # Not larger than a quarter of the image, so that there is room for it beside the vehicle.
    width = int(np.clip(occluder.rectangle.width, 16, source.width // 2))
    height = int(np.clip(occluder.rectangle.height, 16, source.height // 2))
    # A patch of no texture still wins over none: every try may show the vehicle.
    best = -1.0, 0, (0, 0, width, height)
    for _ in range(_PATCH_TRIES):
        index = int(rng.integers(len(footage.truth)))
        left = int(rng.integers(source.width - width + 1))
        top = int(rng.integers(source.height - height + 1))
        if _shows_the_vehicle(footage, index, (left, top, width, height)):
            continue
        part = footage.frame(index)[top : top + height, left : left + width]
        best = max(best, (float(part.std()), index, (left, top, width, height)))
    # The cab leads: it is at the right unless the lorry drives to the left.
    velocity = occluder.motion.velocity[0]
    texture = replace(occluder.texture, frame=best[1], patch=best[2], is_mirrored=velocity < 0)
    return replace(occluder, texture=texture)


def _shows_the_vehicle(
    footage: StressFootage, index: int, patch: tuple[int, int, int, int]
) -> bool:
    truth = footage.truth[index]
    # Unknown: the vehicle may well be in the patch.
    if truth is None:
        return True
    x, y, width, height = patch
    box = truth.box
    beside = box.x + box.width < x or x + width < box.x
    return not (beside or box.y + box.height < y or y + height < box.y)
