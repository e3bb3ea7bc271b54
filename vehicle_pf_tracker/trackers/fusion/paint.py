# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Paint of a vehicle: the median colour in the middle of its box, which excludes strangers."""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation.canonical_patch import cut_image

_PAINTED = 0.6
"""Middle of a box that paint is measured in, of each side: around it are road and shadow. A choice:
its area is a third of the box's."""
_PAINT_SIDE = 8
"""Side in px that it is resampled to: the median of 64 px tolerates 31 of windows and lamps."""
_OTHER_CHROMA = 9.0
"""Difference in Lab's a and b above which two paints are not the same. Over each of 25 sequences a
tenth of the differences is larger; of those between sequences two thirds are."""
_OTHER_LIGHTNESS = 18.0
"""Difference in Lab's L above which two paints are not the same, by the same sequences."""
_SHADED = 2.0
"""Factor of `_OTHER_LIGHTNESS` for single spots: sides of one vehicle differ more than medians. Two
is a choice; the rest is left to chroma alone."""


class Paint(NamedTuple):
    """Paint of a vehicle, as it was last measured.

    Attributes
    ----------
    spots : (8, 8, 3) array of uint8
        Colours in the middle of the box, RGB. Black before the first was measured.
    """

    # Not their median: it is learnt in most frames, and asked for in few.
    spots: Frame = np.zeros((_PAINT_SIDE, _PAINT_SIDE, 3), np.uint8)

    @classmethod
    def of(cls, frame: Frame, position: Array, size: Array) -> Paint:
        """Measure the paint in a box (centre and size, px)."""
        return cls(_spots(frame, position, _PAINTED * size))

    def difference(self, frame: Frame, position: Array, size: Array) -> float:
        """Measure how far the paint in a box is from this one: above 1 it is another."""
        other = Paint.of(frame, position, size)
        # Judged apart: within one vehicle lightness varies twice as much as chroma.
        lightness, *chroma = (other._median() - self._median()).tolist()
        return float(max(abs(lightness) / _OTHER_LIGHTNESS, math.hypot(*chroma) / _OTHER_CHROMA))

    def share(self, frame: Frame, position: Array, size: Array) -> float:
        """Measure the share of a box that has this paint, lighter or darker."""
        off = _lab(_spots(frame, position, size)) - self._median()
        alike = np.abs(off[:, 0]) < _SHADED * _OTHER_LIGHTNESS
        alike &= np.hypot(off[:, 1], off[:, 2]) < _OTHER_CHROMA
        return float(alike.mean())

    def _median(self) -> Array:
        """Median of the colours, as L, a and b (3,)."""
        # The median of an even number of values is the mean of the two in the middle.
        middle = _PAINT_SIDE**2 // 2
        ordered = np.sort(_lab(self.spots), axis=0)
        return np.asarray(ordered[middle - 1 : middle + 1].mean(axis=0), float)


def _spots(frame: Frame, position: Array, size: Array) -> Frame:
    """Spots (8, 8, 3), RGB, in a box of this centre and size (px)."""
    return cut_image(frame, position, _PAINT_SIDE / size, (_PAINT_SIDE, _PAINT_SIDE))


def _lab(spots: Frame) -> Array:
    """Colours (64, 3) of spots, as L, a and b."""
    lab = cv2.cvtColor(spots * np.float32(1 / 255), cv2.COLOR_RGB2Lab)
    return np.asarray(lab.reshape(-1, 3))
