"""What the target looks like: templates, colours, and how far each of these cues is to be trusted.

After P2's principle, a cue that stops telling the target from its surroundings loses weight.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.features.colour_share import (
    Bins,
    Histogram,
    colour_bins,
    contrast_map,
    histogram,
    shares,
)
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.region import Region, cut_region
from vehicle_pf_tracker.features.template import (
    Map,
    Patch,
    coefficient,
    correlate,
    half_coefficients,
    have_structure,
)
from vehicle_pf_tracker.trackers.estimate import Array
from vehicle_pf_tracker.trackers.fusion_parameters import CueParameters
from vehicle_pf_tracker.trackers.fusion_parts.view import CUES, Level, View

Place = tuple[float, float]

_INNER = 0.75
"""Share of the box along each side that templates cover: its border is background."""
_RING = 0.35
"""Width of the ring around the box that colours are held against, of its shorter side."""
_FIRST_COLOUR_LEVEL = 0.5
_LEAST_COLOUR_LEVEL = 0.05
_COLOUR_TRUSTED = (0.5, 0.75)
"""Margins over the surroundings between which colour alone begins to be evidence."""
_MARGIN_RATE = 0.1
_LEAST_MARGIN = 0.02
_ALIKE_BY_COLOUR = 0.95


@dataclass(frozen=True, slots=True)
class Likeness:
    """How alike the image is at one place and size, each 0 to 1.

    Attributes
    ----------
    anchor, following : float
        Correlation with the first template, and with the one that follows.
    part : float
        Largest correlation of a half with either.
    colour : float
        Contrast of the colours, of its usual level, as far as colour can be trusted here.
    """

    anchor: float
    following: float
    part: float
    colour: float

    @property
    def whole(self) -> float:
        """Correlation of the whole with the template that fits better."""
        return max(self.anchor, self.following)

    @property
    def template(self) -> float:
        """Evidence by templates: half of it is left when half of the target is hidden."""
        return 0.5 * self.whole + 0.5 * self.part

    @property
    def evidence(self) -> float:
        """Evidence by templates, or by colours where these are rare around."""
        return max(self.template, _ALIKE_BY_COLOUR * self.colour)


class Appearance:
    """References of one target.

    Parameters
    ----------
    frame : (H, W, 3) array
        The first frame, or the part of it around the target.
    centre : (float, float)
        Of the target in it, px.
    size : (float, float)
        Of the target's box, px.
    side : float
        Geometric mean of the sides of the box at canonical size, in px of a region.
    cues : CueParameters
        Which cues take part.
    """

    def __init__(
        self, frame: Frame, centre: Place, size: Place, side: float, cues: CueParameters
    ) -> None:
        self.size = size
        self.cues = cues
        self._zoom = side / math.sqrt(size[0] * size[1])
        self._inner = (
            max(round(_INNER * size[0] * self._zoom), 3),
            max(round(_INNER * size[1] * self._zoom), 3),
        )
        used = np.array([cues.anchor, cues.following, cues.colour], np.float64)
        self._used = used if used.any() else np.ones(len(CUES))
        self.weights = self._used / self._used.sum()
        self._colour_level = _FIRST_COLOUR_LEVEL
        self._colour_margin = 0.0
        self._pending: deque[Patch] = deque()
        region = self._cut(frame, centre, 1.0, size)
        self._anchor = self._patch(region, centre, 1.0)
        self._following = self._anchor.copy()
        self._target, self._background = self._histograms(region, centre, 1.0)

    @property
    def inner_side(self) -> float:
        """Shorter side of the templates in px of a region."""
        return float(min(self._inner))

    def look(
        self, frame: Frame, centre: Place, scale: float, reach: Place, steps: tuple[float, ...]
    ) -> View:
        """Map the similarity around `centre`.

        Parameters
        ----------
        frame : (H, W, 3) array
            RGB.
        centre : (float, float)
            In px.
        scale : float
            Size that the region is resampled for, relative to the first box.
        reach : (float, float)
            What is looked at beyond the box of this size to either side, px.
        steps : tuple of float
            Sizes to look for, ascending, relative to `scale`.
        """
        region = self._cut(frame, centre, scale, reach)
        grey = region.grey.astype(np.float32)
        share = shares(self._target, self._background)[colour_bins(region.image)]
        return View(region, tuple(self._level(grey, share, scale, step) for step in steps))

    def _level(self, grey: Map, share: Map, scale: float, step: float) -> Level:
        rows, columns = grey.shape
        size = (
            min(max(round(self._inner[0] * step), 3), columns),
            min(max(round(self._inner[1] * step), 3), rows),
        )
        structured = have_structure(grey, size)
        maps = [
            correlate(grey, _resized(template, size), structured)
            for template in (self._anchor, self._following)
        ]
        contrast = contrast_map(share, size, max(round(_RING * min(size)), 2))
        maps.append(np.minimum(contrast / np.float32(self._colour_level), np.float32(1)))
        fused = sum(
            (np.float32(weight) * one for weight, one in zip(self.weights, maps, strict=True)),
            np.zeros_like(maps[0]),
        )
        return Level(scale * step, tuple(maps), fused, (size[0] / 2, size[1] / 2))

    def compare(self, view: View, centre: Place, scale: float) -> Likeness:
        """Hold the image at one place and size against the references."""
        patch = self._patch(view.region, centre, scale)
        used = [
            template
            for template, on in (
                (self._anchor, self.cues.anchor),
                (self._following, self.cues.following),
            )
            if on
        ] or [self._anchor]
        wholes = [max(coefficient(patch, template), 0.0) for template in used]
        part = max(wholes)
        if self.cues.parts:
            part = max(part, *(max(half_coefficients(patch, template)) for template in used))
        return Likeness(wholes[0], wholes[-1], min(part, 1.0), self._colour(view, centre, scale))

    def _colour(self, view: View, centre: Place, scale: float) -> float:
        if not self.cues.colour:
            return 0.0
        low, high = _COLOUR_TRUSTED
        trust = min(max((self._colour_margin - low) / (high - low), 0.0), 1.0)
        return trust * min(max(self._read(view, 2, centre, scale), 0.0), 1.0)

    def _read(self, view: View, cue: int, centre: Place, scale: float) -> float:
        return float(view.cue(cue, np.array([centre]), np.array([scale]))[0])

    def learn(self, view: View, centre: Place, scale: float, rate: float, delay: int) -> None:
        """Let the following template and the colours follow.

        Parameters
        ----------
        view, centre, scale
            Where the target is.
        rate : float
            Share of the new template, 0 to 1.
        delay : int
            Frames that it waits for, so that an occlusion noticed meanwhile is not learnt.
        """
        self._pending.append(self._patch(view.region, centre, scale))
        while len(self._pending) > delay:
            self._following += np.float32(rate) * (self._pending.popleft() - self._following)
        target, background = self._histograms(view.region, centre, scale)
        slow = self.cues.colour_rate
        fast = min(4 * slow, 1.0)  # the surroundings change more often than the target
        self._target += slow * (target - self._target)
        self._background += fast * (background - self._background)
        contrast = self._read(view, 2, centre, scale) * self._colour_level
        level = self._colour_level + _MARGIN_RATE * (contrast - self._colour_level)
        self._colour_level = max(level, _LEAST_COLOUR_LEVEL)

    def forget_pending(self) -> None:
        """Drop what waits to be learnt."""
        self._pending.clear()

    def weigh_cues(self, view: View, centre: Place, scale: float) -> None:
        """Give weight to cues by how far the target stands out from its surroundings."""
        width, height = self.size[0] * scale, self.size[1] * scale
        around = np.array(centre) + np.vstack([_RING_PLACES, 1.4 * _RING_PLACES]) * [width, height]
        scales = np.full(len(around), scale)
        beyond = [np.sort(view.cue(cue, around, scales))[_HIGH] for cue in range(len(CUES))]
        here = [self._read(view, cue, centre, scale) for cue in range(len(CUES))]
        margin = np.array(here) - np.array(beyond)
        self._colour_margin += _MARGIN_RATE * (float(margin[2]) - self._colour_margin)
        if self.cues.adaptive:
            wanted = self._used * np.maximum(margin, _LEAST_MARGIN)
            self.weights += _MARGIN_RATE * (wanted / wanted.sum() - self.weights)

    def _cut(self, frame: Frame, centre: Place, scale: float, reach: Place) -> Region:
        size = self.size[0] * scale + 2 * reach[0], self.size[1] * scale + 2 * reach[1]
        return cut_region(frame, centre, size, self._zoom / scale)

    def _patch(self, region: Region, centre: Place, scale: float) -> Patch:
        """Inner part of the box at a place and size, at canonical size."""
        x, y = region.to_canonical(np.asarray(centre))
        width, height = self._inner
        ax, ay = region.zoom[0] * scale / self._zoom, region.zoom[1] * scale / self._zoom
        matrix = np.array(
            [
                [ax, 0.0, x - 0.5 - ax * (width - 1) / 2],
                [0.0, ay, y - 0.5 - ay * (height - 1) / 2],
            ]
        )
        patch = cv2.warpAffine(
            region.grey, matrix, self._inner, flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        )  # fmt: skip
        return np.asarray(patch, np.float32)

    def _histograms(
        self, region: Region, centre: Place, scale: float
    ) -> tuple[Histogram, Histogram]:
        """Histograms of the box and of what is around it."""
        bins: Bins = colour_bins(region.image)
        x, y = region.to_canonical(np.asarray(centre))
        width = self.size[0] * scale * region.zoom[0]
        height = self.size[1] * scale * region.zoom[1]
        across = np.abs(np.arange(bins.shape[1]) + 0.5 - x) / width
        down = np.abs(np.arange(bins.shape[0]) + 0.5 - y) / height
        away = np.maximum(across[np.newaxis], down[:, np.newaxis])
        return histogram(bins[away < 0.42]), histogram(bins[(away > 0.55) & (away < 1.2)])


def _ring_places() -> Array:
    angles = np.arange(16) * (2 * np.pi / 16)
    return 0.6 * np.column_stack([np.cos(angles), np.sin(angles)])


_RING_PLACES = _ring_places()
"""Places around the target that it has to stand out from, in sizes of its box."""
_HIGH = 28
"""Index of the 0.9 quantile of the 32 places, in ascending order."""


def _resized(patch: Patch, size: tuple[int, int]) -> Patch:
    if (patch.shape[1], patch.shape[0]) == size:
        return patch
    return np.asarray(cv2.resize(patch, size, interpolation=cv2.INTER_LINEAR), np.float32)
