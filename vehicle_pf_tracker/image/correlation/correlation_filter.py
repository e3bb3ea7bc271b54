# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A discriminative correlation filter that is confined to the target and learns step by step.

Li et al., "Learning spatial-temporal regularized correlation filters for visual tracking" (2018),
with a hard spatial limit as in Kiani Galoogahi et al., "Learning background-aware correlation
filters" (2017): the filter may use the target's cells only, and is trained against everything
around it. Each training step solves

    min over g:  1/2 |sum_k x_k * g_k - y|^2  +  stiffness/2 |g - g_before|^2,   g = 0 outside

for one image by a few steps of the alternating direction method of multipliers (ADMM); `x` are the
feature channels, `*` is correlation, and `y` a narrow Gaussian at the target's centre.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.gradient_cells import CellFeatures
from vehicle_pf_tracker.image.correlation.row_waves import Spectrum
from vehicle_pf_tracker.image.correlation.spectra import (
    BY_NUMPY,
    PartialFourier,
    frequencies,
    upsampled,
)

Response: TypeAlias = npt.NDArray[np.float32]
"""Filter response by [y, x], its middle at the patch's centre; 1 is the ideal peak."""

UPSAMPLING = 2
"""Places per cell and axis at which the response is computed; its peak is a cell wide."""
_LABEL_SIGMA = 1 / 16
"""Standard deviation of the ideal response, of the target's side; the value of STRCF."""


class Schedule(NamedTuple):
    """Number of ADMM steps on an image, and growth of the penalty in each of them."""

    steps: int
    growth: float


FIRST_IMAGE = Schedule(steps=8, growth=3.0)
"""On the first image, which all later ones build on: a choice, as it is paid once. The limit in
space is enforced step by step, by a penalty that is 2187 times the first one in the end."""
_LATER_IMAGES = Schedule(steps=2, growth=5.0)
"""On later images: STRCF shows that two steps from the filter before are enough; these two have to
enforce the limit."""


@dataclass(frozen=True, slots=True, eq=False)
class FilterWeights:
    """A trained filter.

    Attributes
    ----------
    target : (channels, rows, columns) array of float32
        The weights of the target's cells; outside they are zero.
    faded : (rows, channels, columns) array of float32
        Weights of the target's cells times the window that an image's cells are faded out by.
    spectrum, conjugate : (channels, n, n // 2 + 1) arrays of complex64
        Half spectrum of the weights, and its conjugate, which responses are made with.
    """

    target: CellFeatures
    faded: CellFeatures
    spectrum: Spectrum
    conjugate: Spectrum


class CorrelationFilter:
    """Finds a target of a given canonical size among the cells around it.

    Parameters
    ----------
    cells : int
        Cells along each side of the patches it sees; even.
    target : (2,) array
        Width and height of the target in cells.
    penalty : float
        First ADMM penalty: the larger, the smoother the filter and the less a step changes it.
    first : Schedule
        Steps on the first image.

    Attributes
    ----------
    waves : RowWaves
        Implementation of a part of the Fourier transforms; all have the same bits.
    """

    def __init__(
        self, cells: int, target: Array, penalty: float, first: Schedule = FIRST_IMAGE
    ) -> None:
        self.penalty = penalty
        self.waves = BY_NUMPY
        self._first = first
        offsets = np.arange(cells) - cells // 2
        sigma = _LABEL_SIGMA * float(np.sqrt(target.prod()))
        label = np.exp(-0.5 * (offsets[:, np.newaxis] ** 2 + offsets**2) / sigma**2)
        spectrum = np.fft.rfft2(np.fft.ifftshift(label)).real / cells**2
        # Of the ideal response, which is even and therefore real, over the places.
        self._label = spectrum[frequencies(cells)].astype(np.float32)
        # The target lies around the middle between two cells, so that its sides are even.
        from_middle = np.abs(np.arange(cells) - (cells - 1) / 2)
        inside = (from_middle[:, np.newaxis] <= target[1] / 2) & (from_middle <= target[0] / 2)
        rows = np.flatnonzero(inside.any(axis=1))
        columns = np.flatnonzero(inside.any(axis=0))
        self._rows = slice(int(rows[0]), int(rows[-1]) + 1)
        self._columns = slice(int(columns[0]), int(columns[-1]) + 1)
        self._target = PartialFourier(cells, self._rows, self._columns)
        # Zeros at the ends are left out: a cell at the border counts little, not nothing.
        window = np.hanning(cells + 2)[1:-1]
        self._faded = PartialFourier(cells, slice(cells), slice(cells), window)
        fading = np.outer(window[self._rows], window[self._columns])
        self._fading = fading[:, np.newaxis].astype(np.float32)
        self._cells = cells
        self.weights: FilterWeights | None = None
        self._wide_weights: Spectrum | None = None

    def spectrum(self, features: CellFeatures) -> Spectrum:
        """Half spectrum of cells (channels, n, n), faded out towards the border."""
        return self._faded.spectrum_of(features, self.waves)

    def train(self, spectrum: Spectrum, stiffness: float) -> None:
        """Learn from one image in whose middle the target is.

        Parameters
        ----------
        spectrum : (channels, n, n // 2 + 1) array
            Spectrum of the image's cells.
        stiffness : float
            Resistance against change; the first image is learnt without any.
        """
        # 1. The right-hand side of the normal equations, which all steps share.
        if self.weights is None:
            right_side = spectrum * self._label
            stiffness = 0.0
            steps, growth = self._first
        else:
            # The gradient of the term that ties the filter to the one before (STRCF eq. 5).
            right_side = self.weights.spectrum * np.float32(stiffness)
            right_side += spectrum * self._label
            steps, growth = _LATER_IMAGES
        # 2. What the steps need of this image.
        conjugate = spectrum.conj()
        # Energy of all channels at each frequency: the only non-zero eigenvalue of x x^H.
        products = spectrum * conjugate
        power = products.sum(axis=0).real
        # 3. ADMM in its scaled form: the multiplier, with the solution added, is confined.
        # Nothing is confined yet, and the multiplier is zero, so that the first right-hand side is
        # all; its solution is the multiplier. Written in place: few spectra fit into the cache of a
        # core.
        right = right_side
        multiplier = confined = np.empty_like(right_side)
        for step in range(steps):
            penalty = self.penalty * growth**step
            if step:
                # The multiplier is scaled by the penalty, which has just grown.
                multiplier -= confined
                multiplier *= np.float32(1 / growth)
                right = np.subtract(confined, multiplier, out=confined)
                right *= np.float32(penalty)
                right += right_side
            # Solve (x x^H / places + total) f = right at each frequency (Sherman and Morrison).
            total = penalty + stiffness
            share = np.multiply(conjugate, right, out=products).sum(axis=0)
            share /= power + np.float32(self._cells**2 * total)
            right = np.subtract(right, np.multiply(spectrum, share, out=products), out=confined)
            right *= np.float32(1 / total)
            if step:
                multiplier += right
            # There and back through the cells of the target: what is outside becomes zero.
            cells = self._target.cells_of(multiplier, self.waves)
            confined = self._target.spectrum_of(cells, self.waves)
        self._wide_weights = None
        faded = cells.transpose(1, 0, 2) * self._fading
        self.weights = FilterWeights(cells, faded, confined, confined.conj())

    def respond(self, spectrum: Spectrum) -> Response:
        """Respond to cells (half spectrum), at `UPSAMPLING` places per cell."""
        return self._response(spectrum * self._trained.conjugate)

    @property
    def extent(self) -> tuple[int, int]:
        """Columns and rows of the target's cells; even."""
        columns = self._columns
        rows = self._rows
        return columns.stop - columns.start, rows.stop - rows.start

    def respond_in_middle(self, features: CellFeatures) -> float:
        """Respond to the cells (channels, r, c) of a smaller piece at its centre only.

        Columns and rows are even, and at least those of the target.
        """
        count = features.shape[1:]
        columns, rows = self.extent
        top = (count[0] - rows) // 2
        left = (count[1] - columns) // 2
        # Without a transform: of a response only its middle is wanted, a sum of products.
        seen = features.transpose(1, 0, 2)[top : top + rows, :, left : left + columns]
        # Long dot products of BLAS are summed by several threads, and rounded otherwise then.
        return float(np.einsum("rcx,rcx->", seen, self._trained.faded))

    def wide_spectrum(self, features: CellFeatures) -> Spectrum:
        """Half spectrum of the cells (channels, m, m) of a larger patch, m even and above n."""
        return self._wide(features.shape[1])[0].spectrum_of(features, self.waves)

    def respond_wide(self, spectrum: Spectrum) -> Response:
        """Respond to the cells of a larger patch."""
        if self._wide_weights is None:
            # Transformed when first asked for: a wide search happens in few frames.
            target = self._wide(spectrum.shape[1])[1]
            self._wide_weights = target.spectrum_of(self._trained.target, self.waves).conj()
        return self._response(self._wide_weights * spectrum)

    @property
    def _trained(self) -> FilterWeights:
        assert self.weights is not None, "train the filter first"
        return self.weights

    def _response(self, answers: Spectrum) -> Response:
        """Response by the products of the spectra of cells and conjugate weights."""
        return upsampled(answers.sum(axis=0), UPSAMPLING, self.waves)

    def _wide(self, size: int) -> tuple[PartialFourier, PartialFourier]:
        """Return transforms of a larger square of cells, and of the target in its middle."""
        margin = (size - self._cells) // 2
        edges = self._rows.start, self._rows.stop, self._columns.start, self._columns.stop
        inside = _transforms(size, *(edge + margin for edge in edges))
        return _transforms(size, 0, size, 0, size), inside


@functools.cache
def _transforms(size: int, top: int, bottom: int, left: int, right: int) -> PartialFourier:
    return PartialFourier(size, slice(top, bottom), slice(left, right))
