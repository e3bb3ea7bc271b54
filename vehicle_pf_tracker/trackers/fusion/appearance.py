"""What the target looks like: templates, colours, and how far each of these cues is to be trusted.

After P2's principle, a cue that stops telling the target from its surroundings loses weight.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.alignment import Alignment, Step
from vehicle_pf_tracker.image.colour_share import (
    Histogram,
    bin_count,
    colour_bins,
    histogram,
    is_grey,
    mean_share_map,
    shares,
)
from vehicle_pf_tracker.image.region import Region, cut_region
from vehicle_pf_tracker.image.template import (
    Map,
    Patch,
    best_coefficient,
    correlate,
    halves,
    have_structure,
)
from vehicle_pf_tracker.trackers.fusion.parameters import CueParameters
from vehicle_pf_tracker.trackers.fusion.view import CUES, View

_LEAST_TEMPLATE = 5
"""px of the region."""
_INNER = 0.75
"""Share of the box along each side that templates cover: its border is background."""
_COLOURED = 0.85
"""Share of the box along each side that colours are averaged in."""
_TARGET = 0.42
_SURROUNDINGS = 0.55
"""Distance from the centre, in sizes of the box, up to and from which histograms count."""
_BASE_WEIGHTS = np.array([0.25, 0.5, 0.25])
_WEIGHT_RATE = 0.05
_LEAST_MARGIN = 0.1
_ALIGNING_STEPS = 3
_FARTHEST_ALIGNED = 0.2
"""Of the size."""
_LARGEST_ALIGNED = 0.06
"""Change of the logarithm of the scale."""
_EXPECTED_SIGMA = 0.02
_WORSE = 0.02
_SLACK = 2
"""px of the region by which a half may be off its place in the whole."""
_COLOURS_LEARNT_EVERY = 4
_OLD_TARGET = 0.9
_OLD_BACKGROUND = 0.8
"""What stays of the histograms when the box takes another shape."""
_BACKGROUND_RATE = 3.0
"""The surroundings change more often than the target."""


@dataclass(frozen=True, slots=True)
class Likeness:
    """How alike the image is at one place and size, each 0 to 1.

    Attributes
    ----------
    anchor, following : float
        Correlation with the first template, and with the one that follows.
    colour : float
        Mean share of the colours in the box.
    """

    anchor: float
    following: float
    colour: float


@dataclass(frozen=True, slots=True)
class Aligned:
    """Place in px and scale that the following template fits best, and its correlation there."""

    place: Position
    scale: float
    coefficient: float


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
    cues : CueParameters
        Which cues take part, and how they are learnt.
    grey : bool, optional
        Whether the video has no colours; by default that is seen from the frame.
    """

    def __init__(
        self,
        frame: Frame,
        centre: Position,
        size: Position,
        cues: CueParameters,
        *,
        grey: bool | None = None,
    ) -> None:
        self.size = size
        self._zoom = cues.side / math.sqrt(size[0] * size[1])
        self._shape = (
            max(round(size[0] * self._zoom), _LEAST_TEMPLATE),
            max(round(size[1] * self._zoom), _LEAST_TEMPLATE),
        )
        self.use(cues)
        self._frames = 0
        region = self._cut(frame, centre, 1.0, (0.75 * size[0], 0.75 * size[1]))
        self.grey = is_grey(region.image) if grey is None else grey
        self._anchor = self._patch(region, centre, 1.0)
        self._following = self._anchor.copy()
        self._target, self._background = self._histograms(region, centre, 1.0)

    def reshaped(self, frame: Frame, centre: Position, size: Position) -> Appearance:
        """Learn the templates anew in a box of another shape; the colours mostly stay."""
        other = Appearance(frame, centre, size, self.cues, grey=self.grey)
        other.weights = self.weights
        other._target += _OLD_TARGET * (self._target - other._target)
        other._background += _OLD_BACKGROUND * (self._background - other._background)
        return other

    def mean_share(self, pixels: Frame) -> float:
        """Mean share of pixels (n, m, 3) that speaks for the target, 0 to 1."""
        share = shares(self._target, self._background)
        return float(share[colour_bins(pixels, grey=self.grey)].mean())

    def use(self, cues: CueParameters) -> None:
        """Let other cues take part from now on."""
        used = _BASE_WEIGHTS * [cues.anchor, cues.following, cues.colour]
        base = used / used.sum() if used.any() else _BASE_WEIGHTS
        self.cues, self._base, self.weights = cues, base, base.copy()

    def look(
        self, frame: Frame, centre: Position, scale: float, reach: float, steps: tuple[float, ...]
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
        reach : float
            What is looked at beyond the box of this size to every side, px.
        steps : tuple of float
            Sizes to look for, ascending by a constant factor, relative to `scale`.
        """
        region = self._cut(frame, centre, scale, (reach, reach))
        grey = region.grey.astype(np.float32)
        bins = colour_bins(region.image, grey=self.grey)
        share = shares(self._target, self._background)[bins]
        cues = np.zeros((len(CUES), len(steps), *grey.shape), np.float32)
        for number, step in enumerate(steps):
            self._correlate(grey, step, cues[:2, number])
            cues[2, number] = mean_share_map(share, self._odd(_COLOURED, step))
        fused = np.tensordot(self.weights.astype(np.float32), cues, axes=1)
        return View(region, scale * np.array(steps), cues, fused)

    def _correlate(self, grey: Map, step: float, maps: Map) -> None:
        """Fill the maps (2, h, w) of both templates; windows over the border stay at zero."""
        width, height = self._odd(_INNER, step)
        rows, columns = grey.shape
        if height > rows or width > columns:
            return
        structured = have_structure(grey, (width, height))
        top, left = height // 2, width // 2
        inside = np.s_[top : top + rows - height + 1, left : left + columns - width + 1]
        for template, into in zip((self._anchor, self._following), maps, strict=True):
            found = correlate(grey, self._inner(template, step), structured)
            into[inside] = np.maximum(found, 0)

    def _odd(self, share: float, step: float) -> tuple[int, int]:
        """Give the odd size of a part of the target in px of a region."""
        width, height = (
            max(round(side * share * step), _LEAST_TEMPLATE) | 1 for side in self._shape
        )
        return width, height

    def _inner(self, template: Patch, step: float) -> Patch:
        """Inner part of a template, `step` times as large."""
        width, height = self._odd(_INNER, step)
        across, down = self._shape
        # Sampled at exactly 1 / step, so that neighbouring sizes differ though both are odd.
        matrix = np.array(
            [
                [1 / step, 0.0, (across - 1) / 2 - (width - 1) / (2 * step)],
                [0.0, 1 / step, (down - 1) / 2 - (height - 1) / (2 * step)],
            ]
        )
        return _warped(template, matrix, (width, height))

    def compare(self, view: View, centre: Position, scale: float) -> Likeness:
        """Read all cues at one place and size."""
        anchor, following, colour = view.read(view.cues, np.array([centre]), np.array([scale]))[
            :, 0
        ].tolist()
        if not self.cues.following:
            following = anchor if self.cues.anchor else colour
        if not self.cues.anchor:
            anchor = following
        return Likeness(anchor, following, colour)

    def align(self, view: View, centre: Position, scale: float, expected: float) -> Aligned:
        """Align the following template, from a place and size on, to fractions of a pixel.

        Parameters
        ----------
        view, centre, scale
            Where to begin.
        expected : float
            Scale that the motion foretells, which the outcome is drawn to.
        """
        alignment = Alignment(self._following)
        far = _FARTHEST_ALIGNED * math.sqrt(self.size[0] * self.size[1]) * scale
        (x, y), growth, best = centre, 0.0, Aligned(centre, scale, -1.0)
        for number in range(_ALIGNING_STEPS + 1):
            now = scale * math.exp(growth)
            step = alignment.step(
                self._patch(view.region, (x, y), now), math.log(now / expected), _EXPECTED_SIGMA
            )
            if step.coefficient > best.coefficient:
                best = Aligned((x, y), now, step.coefficient)
            elif step.coefficient < best.coefficient - _WORSE:
                break
            x += now / self._zoom * step.place[0]
            y += now / self._zoom * step.place[1]
            growth += step.log_scale
            away = max(abs(x - centre[0]), abs(y - centre[1]))
            if away > far or abs(growth) > _LARGEST_ALIGNED or (number and _is_tiny(step)):
                break
        return best

    def best_half(self, view: View, centre: Position, scale: float) -> float:
        """Largest correlation of a half of the following template near its place.

        A vehicle that is half hidden is still half alike; 1 with `cues.parts` off would call it
        whole, so then it is 0.
        """
        if not self.cues.parts:
            return 0.0
        region = view.region
        inner = self._inner(self._following, scale * region.zoom[0] / self._zoom)
        height, width = inner.shape
        x, y = region.to_canonical(np.asarray(centre)).tolist()
        left, top = round(x - width / 2), round(y - height / 2)
        found = [0.0]
        for rows, columns in halves(inner.shape):
            half = inner[rows, columns]
            first_row, first_column = top + (rows.start or 0), left + (columns.start or 0)
            around = region.grey[
                max(first_row - _SLACK, 0) : max(first_row + half.shape[0] + _SLACK, 0),
                max(first_column - _SLACK, 0) : max(first_column + half.shape[1] + _SLACK, 0),
            ]
            found.append(best_coefficient(around, half))
        return max(found)

    def learn(self, view: View, centre: Position, scale: float, rate: float) -> None:
        """Let the following template take on `rate` of what is seen at a place and size."""
        seen = self._patch(view.region, centre, scale)
        self._following += np.float32(rate) * (seen - self._following)

    def learn_colours(self, view: View, centre: Position, scale: float) -> None:
        """Let the histograms follow, every few frames."""
        self._frames += 1
        if self._frames % _COLOURS_LEARNT_EVERY:
            return
        target, background = self._histograms(view.region, centre, scale)
        rate = self.cues.colour_rate
        self._target += rate * (target - self._target)
        self._background += min(_BACKGROUND_RATE * rate, 1.0) * (background - self._background)

    def weigh_cues(self, view: View, centre: Position, scale: float) -> None:
        """Give weight to cues by how far the target stands out from its surroundings (P2 eq. 8)."""
        if not self.cues.adaptive:
            return
        size = np.array(self.size) * scale
        around = np.asarray(centre) + _RING * size
        places = np.vstack([centre, around])
        values = view.read(view.cues, places, np.full(len(places), scale))
        margins = values[:, 0] - np.sort(values[:, 1:], axis=1)[:, _HIGH]
        wanted = self._base * np.maximum(margins, _LEAST_MARGIN)
        self.weights += _WEIGHT_RATE * (wanted / wanted.sum() - self.weights)

    def _cut(self, frame: Frame, centre: Position, scale: float, reach: Position) -> Region:
        size = self.size[0] * scale + 2 * reach[0], self.size[1] * scale + 2 * reach[1]
        return cut_region(frame, centre, size, self._zoom / scale)

    def _patch(self, region: Region, centre: Position, scale: float) -> Patch:
        """Cut the box at a place and size out of a region, at canonical size."""
        x, y = region.to_canonical(np.asarray(centre)).tolist()
        width, height = self._shape
        ax, ay = region.zoom[0] * scale / self._zoom, region.zoom[1] * scale / self._zoom
        matrix = np.array(
            [
                [ax, 0.0, x - 0.5 - ax * (width - 1) / 2],
                [0.0, ay, y - 0.5 - ay * (height - 1) / 2],
            ]
        )
        return _warped(region.grey, matrix, self._shape)

    def _histograms(
        self, region: Region, centre: Position, scale: float
    ) -> tuple[Histogram, Histogram]:
        """Histograms of the box and of what is around it."""
        bins = colour_bins(region.image, grey=self.grey)
        x, y = region.to_canonical(np.asarray(centre)).tolist()
        width = self.size[0] * scale * region.zoom[0]
        height = self.size[1] * scale * region.zoom[1]
        across = np.abs(np.arange(bins.shape[1]) + 0.5 - x) / width
        down = np.abs(np.arange(bins.shape[0]) + 0.5 - y) / height
        away = np.maximum(across[np.newaxis], down[:, np.newaxis])
        count = bin_count(grey=self.grey)
        return histogram(bins[away < _TARGET], count), histogram(bins[away > _SURROUNDINGS], count)


def _warped(image: np.ndarray, matrix: Array, size: tuple[int, int]) -> Patch:
    """Sample an image (h, w) at ``matrix @ (x, y, 1)`` for each pixel of the outcome."""
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    patch = cv2.warpAffine(image, matrix, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(patch, np.float32)


def _is_tiny(step: Step) -> bool:
    x, y = step.place
    return abs(x) + abs(y) < 0.02 and abs(step.log_scale) < 0.001


def _ring() -> Array:
    angles = np.arange(16) * (2 * np.pi / 16)
    return 0.7 * np.column_stack([np.cos(angles), np.sin(angles)])


_RING = _ring()
"""Places around the target that it has to stand out from, in sizes of its box."""
_HIGH = 13
"""Index of the 0.85 quantile of them, in ascending order."""
