# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Appearance of the target: cells of gradients and colour, and the filter that finds them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch, cut_image, cut_patch
from vehicle_pf_tracker.image.correlation.correlation_filter import (
    UPSAMPLING,
    CorrelationFilter,
    Response,
)
from vehicle_pf_tracker.image.correlation.gradient_cells import GRADIENT_CELL_PX
from vehicle_pf_tracker.image.correlation.row_waves import Spectrum
from vehicle_pf_tracker.image.correlation.spectra import shifted
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.patches.cells import cells_of
from vehicle_pf_tracker.trackers.fusion.paint import Paint

_CELLS = 32
"""Cells along each side of a patch: three times the target's ten, so that background is learnt on
all sides; a power of two for the Fourier transform."""
_WIDE_CELLS = 64
"""Cells along each side while a hidden vehicle is searched for far around: the next such power."""
_TARGET_SIDE = 40.0
"""Geometric mean of the target's canonical sides, px: ten cells, and 0.3 of the patch."""
_LARGEST_ZOOM = 8.0
"""Bound of canonical px per px of the frame: below 5 px a vehicle has nothing more to magnify."""
_LONGEST_IN_PATCH = 0.6
"""Longest side of the target in the patch: beyond, no background would be left to learn."""
_STEP_PX = GRADIENT_CELL_PX / UPSAMPLING
"""Canonical px from one place of the response to the next."""
_SHIFTABLE_PX = 6.0
"""Offset in canonical px up to which cells are moved circularly instead of measured again: what is
wrapped around was faded out. That is one and a half cells of 32."""
_LEAST_OF_FIRST = 0.3
"""Least usual response, fraction of that to the first frame: the second one of the sequences gives
0.37 to 0.89 of it, a hidden vehicle 0.03. A filter may be trained anew while it is hidden."""
_TINY_RESPONSE = 1e-3
"""Least usual response: where nothing was learnt, as on a flat image, no ratio may become one of
zeros."""
_RIM = 1
"""Cells around the target that are measured with it: their gradients normalise its outermost."""


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """The response of the filter around a predicted position.

    Attributes
    ----------
    patch : Patch
        The surroundings.
    spectrum : (channels, n, n // 2 + 1) array or None
        Spectrum of their cells; None for a wide view.
    response : (m, m) array
        Response by [y, x], relative to the usual one of visible frames.
    """

    patch: Patch
    spectrum: Spectrum | None
    response: Response

    @property
    def steps(self) -> Array:
        """Places of the response per px of the frame, along x and y."""
        return self.patch.zoom / _STEP_PX

    def places(self, positions: Array) -> npt.NDArray[np.intp]:
        """Nearest places (..., 2), as x and y, of positions in px of the frame."""
        last = len(self.response) - 1
        # The patch's centre is between two cells, at place m / 2. A hypothesis beyond the patch
        # takes the response at its rim; few are (`observe._WIDE_FROM`).
        exact = (positions - self.patch.centre) * self.steps + len(self.response) / 2
        return np.minimum(np.maximum(np.rint(exact), 0), last).astype(np.intp)

    def position(self, column: float, row: float) -> Array:
        """Position in px of the frame of a place, which may lie between those of the response."""
        middle = len(self.response) / 2
        offset = np.array([column - middle, row - middle])
        return np.asarray(self.patch.centre + offset / self.steps)

    def at(self, position: Array) -> float:
        """Response at the place nearest to a position in px."""
        column, row = self.place(position)
        return float(self.response[row, column])

    def place(self, position: Array) -> tuple[int, int]:
        """Nearest place, as x and y, of one position (2,) in px of the frame."""
        # As `places`, in scalars, which are quicker for one.
        last = len(self.response) - 1
        middle = len(self.response) / 2
        x, y = position.tolist()
        left, top = self.patch.centre.tolist()
        across, down = self.patch.zoom.tolist()
        column = round((x - left) * (across / _STEP_PX) + middle)
        row = round((y - top) * (down / _STEP_PX) + middle)
        return min(max(column, 0), last), min(max(row, 0), last)

    def peak_near(self, position: Array, reach: int) -> tuple[Array, float]:
        """Find the peak within `reach` places of a position: its position in px, and height."""
        # One place is left free at each border: the parabola needs both neighbours of the peak.
        inner = len(self.response) - 2 - reach
        column, row = (min(max(place, reach + 1), inner) for place in self.place(position))
        near = self.response[row - reach : row + reach + 1, column - reach : column + reach + 1]
        dy, dx = divmod(int(near.argmax()), 2 * reach + 1)
        x = column - reach + dx
        y = row - reach + dy
        (_, above, _), (left, top, right), (_, below, _) = self.response[
            y - 1 : y + 2, x - 1 : x + 2
        ].tolist()
        # Places are 2 canonical px apart, a twentieth of the target: too coarse for a velocity.
        exact = x + _vertex(left, top, right), y + _vertex(above, top, below)
        return self.position(*exact), top


def _vertex(before: float, at: float, after: float) -> float:
    """Offset of the vertex of a parabola through three equidistant values, at most half a step."""
    bend = before + after - 2 * at
    # Next to the highest value the vertex is within half a step; the bound holds at the window's
    # rim, where the value may not be the highest, and a bend upwards has no vertex to go to.
    return min(max(0.5 * (before - after) / bend, -0.5), 0.5) if bend < 0 else 0.0


class Appearance:
    """The target's filter and paint, learnt from patches of canonical size.

    Parameters
    ----------
    kernels : Kernels
        Implementation that measures gradients and transforms spectra.
    size, learnt : (2,) arrays
        Width and height of the target in the first frame, and of the part that is learnt, px.
    penalty : float
        See `FilterParameters`.

    Attributes
    ----------
    kernels : Kernels
        Implementation in use; see `use_kernels`.
    """

    def __init__(self, kernels: Kernels, size: Array, learnt: Array, penalty: float) -> None:
        # The part that is learnt has the canonical size; the box is carried along in its scale, so
        # that patches can be asked for by the box, whatever part of it the filter knows.
        zoom = min(_TARGET_SIDE / math.sqrt(learnt.prod()), _LARGEST_ZOOM)
        self._side = _CELLS * GRADIENT_CELL_PX
        target = np.minimum(learnt * zoom, _LONGEST_IN_PATCH * self._side)
        self._box = target * (size / learnt)
        self._filter = CorrelationFilter(_CELLS, target / GRADIENT_CELL_PX, penalty)
        self.use_kernels(kernels)
        # Unknown until the first patch after the start (`has_level`).
        self.usual_response = 0.0
        self._least_usual = 0.0
        self._paint = Paint()

    def use_kernels(self, kernels: Kernels) -> None:
        """Measure gradients and transform spectra by another implementation from now on."""
        self.kernels = kernels
        self._filter.waves = kernels.row_waves

    def patch(self, frame: Frame, position: Array, size: Array, *, wide: bool = False) -> Patch:
        """Cut the surroundings of a box of this centre and size (px) out of a frame."""
        side = _WIDE_CELLS * GRADIENT_CELL_PX if wide else self._side
        return cut_patch(frame, position, self._box / size, side)

    def usual_patch(self, patch: Patch) -> Patch:
        """Return the part of a wide patch that a usual one shows; a usual one itself."""
        return patch if patch.side == self._side else patch.middle(self._side)

    def view(self, patch: Patch) -> View:
        """Respond to a patch; the usual response has to be known."""
        # A wide spectrum cannot be trained on: it has other frequencies than the filter.
        wide = patch.side > self._side
        respond = self._filter.respond_wide if wide else self._filter.respond
        spectrum = self._spectrum(patch)
        response = respond(spectrum) / np.float32(self.usual_response)
        return View(patch, None if wide else spectrum, response)

    @property
    def has_level(self) -> bool:
        """True once the usual response is known, which all responses are relative to."""
        return self.usual_response > 0

    def learn_level(self, patch: Patch) -> None:
        """Take the highest response to the first patch after a start for the usual one."""
        # Not the response to the first frame: a filter answers better to the image that it was
        # trained on than to any other, and all later responses would look low.
        respond = self._filter.respond_wide if patch.side > self._side else self._filter.respond
        highest = float(respond(self._spectrum(patch)).max())
        self.usual_response = max(highest, self._least_usual, _TINY_RESPONSE)

    def responses_at(
        self, frame: Frame, position: Array, sizes: Sequence[Array]
    ) -> Sequence[float]:
        """Responses to boxes of one centre and several sizes (px), relative to the usual one."""
        # Sizes are compared at one position: only the target's cells are measured, and no spectrum.
        columns, rows = (count + 2 * _RIM for count in self._filter.extent)
        piece = columns * GRADIENT_CELL_PX, rows * GRADIENT_CELL_PX
        # One below the other: most of the time of such small pieces is that of the calls.
        image = np.concatenate(
            [cut_image(frame, position, self._box / size, piece) for size in sizes]
        )
        grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), np.uint8)
        return [
            self._filter.respond_in_middle(features) / self.usual_response
            for features in cells_of(self.kernels, image, grey, len(sizes))
        ]

    def learn_first(self, frame: Frame, position: Array, size: Array) -> None:
        """Train the filter on the first frame."""
        self.learn_paint(frame, position, size)
        spectrum = self._spectrum(self.patch(frame, position, size))
        self._filter.train(spectrum, 0.0)
        # The next patch may not show the vehicle: its response alone would be no safe level.
        self._least_usual = _LEAST_OF_FIRST * float(self._filter.respond(spectrum).max())

    def learn(self, frame: Frame, view: View, position: Array, size: Array, stiff: float) -> None:
        """Train the filter on the target at `position` in the frame that `view` shows."""
        # The patch is centred on the prediction, the target a little beside: moving the cells costs
        # less than measuring them again, and small moves wrap around only what was faded out.
        offset = (position - view.patch.centre) * view.patch.zoom
        if view.spectrum is not None and np.abs(offset).max() < _SHIFTABLE_PX:
            x, y = (-offset / GRADIENT_CELL_PX).tolist()
            spectrum = shifted(view.spectrum, x, y)
        else:
            spectrum = self._spectrum(self.patch(frame, position, size))
        self._filter.train(spectrum, stiff)

    def learn_usual(self, response: float, rate: float) -> None:
        """Let the usual response follow one of a visible frame, given relative to it."""
        # An exponential mean, written for a response that is itself relative to it.
        self.usual_response *= 1 + rate * (response - 1)

    def learn_paint(self, frame: Frame, position: Array, size: Array) -> None:
        """Measure the paint of a vehicle that is clearly seen whole: occluders have another."""
        self._paint = Paint.of(frame, position, size)

    def paint_difference(self, frame: Frame, position: Array, size: Array) -> float:
        """Measure how far the paint in a box is from the one learnt last: above 1 it is another."""
        return self._paint.difference(frame, position, size)

    def paint_share(self, frame: Frame, position: Array, size: Array) -> float:
        """Measure the share of a box that has the paint learnt last, lighter or darker."""
        return self._paint.share(frame, position, size)

    def _spectrum(self, patch: Patch) -> Spectrum:
        wide = patch.side > self._side
        transform = self._filter.wide_spectrum if wide else self._filter.spectrum
        (features,) = cells_of(self.kernels, patch.image, patch.grey)
        return transform(features)
