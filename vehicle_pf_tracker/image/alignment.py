"""Alignment of a template in place and scale to fractions of a pixel, by Gauss-Newton steps.

Inverse compositional: the template is differentiated, not the image, so that one set of derivatives
serves all steps of a frame. What light multiplies and adds takes no part.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.image.template import Patch

_BLUR = (3, 3), 0.7
_SOFT_BORDER = 4.0
"""Slope of the window at its border, which may show background."""
_BORDER_WEIGHT = 0.15
_DAMPING = 0.01
_CAUCHY = 2.0
"""Residuals in standard deviations that count for half: half covered, a vehicle still aligns."""
_INDEPENDENT_PIXELS = 50.0
"""Number of pixels with independent errors: neighbours err alike."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step of an alignment.

    Attributes
    ----------
    coefficient : float
        Correlation before it, -1 to 1.
    place : (float, float)
        How far the image lies beside the template, px of the template.
    log_scale : float
        How much larger the image shows it, as a logarithm.
    """

    coefficient: float
    place: tuple[float, float]
    log_scale: float


class Alignment:
    """A template with its derivatives.

    Parameters
    ----------
    template : (h, w) array of float32
        Grey levels.
    """

    def __init__(self, template: Patch) -> None:
        x, y, self._window = _grid(*template.shape)
        smooth = _smooth(template)
        across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, ksize=3, scale=0.125)
        down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, ksize=3, scale=0.125)
        self._derivatives = np.stack([across, down, across * x + down * y]).reshape(3, -1)
        self._template = self._centred(smooth)
        self._energy = float(self._window @ self._template**2) + 1e-6

    def _centred(self, patch: Patch) -> Patch:
        flat = patch.ravel()
        return np.asarray(flat - self._window @ flat, np.float32)

    def step(self, patch: Patch, away: float, sigma: float) -> Step:
        """Compare a patch cut at the present place and scale.

        Parameters
        ----------
        patch : (h, w) array
            Of the template's shape.
        away : float
            Logarithm of the present scale over the expected one.
        sigma : float
            Standard deviation of the expected one's logarithm.
        """
        image = self._centred(_smooth(patch))
        energy = float(self._window @ image**2) + 1e-6
        common = float(self._window @ (image * self._template))
        coefficient = common / math.sqrt(energy * self._energy)
        error = image * np.float32(common / energy) - self._template
        deviation = 1.25 * float(self._window @ np.abs(error)) + 1.0
        weights = self._window / (1 + (error / (_CAUCHY * deviation)) ** 2)
        matrix, vector = self._normal_equations(error, weights)
        trust = deviation**2 / (_INDEPENDENT_PIXELS * sigma**2)
        matrix[2, 2] += trust
        vector[2] += trust * away
        x, y, growth = np.linalg.solve(matrix, vector).tolist()
        return Step(coefficient, (-x, -y), -growth)

    def _normal_equations(self, error: Patch, weights: Patch) -> tuple[np.ndarray, np.ndarray]:
        """Weighted least squares in place and scale, with an offset of the light eliminated."""
        weighted = self._derivatives * weights
        total = float(weights.sum())
        means, mean_error = weighted.sum(axis=1) / total, float(weights @ error) / total
        matrix = (weighted @ self._derivatives.T).astype(np.float64)
        matrix -= total * np.outer(means, means)
        vector = (weighted @ error).astype(np.float64) - total * means * mean_error
        matrix[np.diag_indices(3)] = matrix.diagonal() * (1 + _DAMPING) + 1e-3
        return matrix, vector


@functools.lru_cache(maxsize=8)
def _grid(height: int, width: int) -> tuple[Patch, Patch, Patch]:
    """Coordinates from the centre along x (1, w) and y (h, 1), and the soft window (h * w,)."""
    x = _centred_range(width)[np.newaxis]
    y = _centred_range(height)[:, np.newaxis]
    shares = [_centred_range(side) / np.float32(side) for side in (height, width)]
    window = np.outer(*(_soft(np.asarray(one, np.float32)) for one in shares)).ravel()
    return x, y, np.asarray(window / window.sum(), np.float32)


def _centred_range(count: int) -> Patch:
    return np.asarray(np.arange(count) - (count - 1) / 2, np.float32)


def _smooth(patch: Patch) -> Patch:
    return np.asarray(cv2.GaussianBlur(patch, *_BLUR), np.float32)


def _soft(share: Patch) -> Patch:
    """Window over shares -0.5 to 0.5 of a side: 1 inside, little at the border."""
    weights = _SOFT_BORDER * (0.5 - np.abs(share)) + _BORDER_WEIGHT
    return np.asarray(np.clip(weights, 0, 1), np.float32)
