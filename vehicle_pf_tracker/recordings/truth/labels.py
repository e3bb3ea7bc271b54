# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Labels, the truth of a target in one image as a file states it, and the images they belong to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion

Sides: TypeAlias = tuple[float, float, float, float]
"""Left, top, width and height, px."""
ABSENT_SIDES: Sides = (math.nan, math.nan, math.nan, math.nan)
OTHER_SHAPES = -(2**31)
"""Identity of shapes that have no number in their file: no target's."""


class UnreadTruthError(InputError):
    """Raised for a file that looks like truth, but has no known format or several targets."""


@dataclass(frozen=True, slots=True)
class Images:
    """The images that truth belongs to.

    Attributes
    ----------
    numbers : sequence of int
        Numbers of the images, in order.
    size : callable
        Reads the width and height in px.
    names : mapping of str to int
        The number of each image file; empty for a video.
    """

    numbers: Sequence[int]
    size: Callable[[], tuple[int, int]]
    names: Mapping[str, int]

    def nth(self, index: int) -> int:
        """Return the number of an image by its index from 0, also of one that is not there."""
        # Beyond the ends the count goes on, so that truth of missing images has distinct numbers.
        last = len(self.numbers) - 1
        near = min(max(index, 0), last)
        return self.numbers[near] + index - near


@dataclass(frozen=True, slots=True)
class Label:
    """Truth of a target in one image, as its file states it.

    Attributes
    ----------
    where : str
        Place in the file, for an error.
    number : float
        Number of the image.
    sides : tuple of float
        Left, top, width and height in px; NaN or no area where the target is absent.
    occlusion : Occlusion
        Degree of occlusion.
    identity : float
        Number of the target; 1 where the file has but one.
    fault : str
        Reason why the label cannot be read, as the end of a sentence; empty where it can.
    """

    where: str
    number: float
    sides: Sides
    occlusion: Occlusion = Occlusion.NONE
    identity: float = 1
    fault: str = ""


Reader: TypeAlias = Callable[[Path, str, Images], Iterator[Label]]
"""Reads the labels of a file: its path, its text, and the images."""
