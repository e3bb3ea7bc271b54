# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Model of the background of a standing camera: a few earlier colours of every pixel.

A pixel is background where two of its samples have its colour; samples are renewed at random where
the background is seen, and some are given to a neighbour, so that leaves and uncovered road are
learnt from their surroundings (Barnich and Van Droogenbroeck 2011). What has changed is not learnt
until it has stayed for long: a lorry of one colour hides a place for seconds, and would melt in.
"""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.detection.exposure import Curves, exposure_change
from vehicle_pf_tracker.detection.holes import Section, is_hole, standing_parts
from vehicle_pf_tracker.detection.motion_thresholds import MotionThresholds

Colours = npt.NDArray[np.uint8]
Planes = npt.NDArray[np.uint8]
"""Channels of an image, one below the other: sums over them are ten times as fast."""
Pixels = npt.NDArray[np.bool_]
Mask = npt.NDArray[np.uint8]

_SAMPLES = 10
"""Colours that are remembered of each pixel. A choice: time and memory grow with them, and what
moves to and fro, like leaves, has more colours than a few."""
_BETWEEN = 2
"""Images from one of the first samples to the next: most pixels are free in two of ten."""
_SAMPLE_INTERVAL = 0.06
"""Interval of images, about two of 30 Hz, s, from which each of the first ones is a sample: by then
what drives has moved on. A choice; between those of cameras of 15 and 20 Hz, so that the jitter of
stamps decides nothing."""
_AGREEING = 2
"""Least samples of the pixel's colour for it to be background: one may be of a vehicle."""
_LOOKED_AT = 4
"""Samples that all pixels are compared with: nine in ten are background by two of these."""
_RENEWED = 40
"""Images after which a sample is renewed, on average: light and leaves change within a second."""
_SHADE = 20.0
"""Largest distance in colour, levels, of a shadow from the darkened background, by its share of the
brightness. A choice: several times the noise of a channel, and less than another paint."""
_COMPARED = 3
"""One of this many samples makes the background that shadows are found by: a mean is enough."""
_EDGE = 0.04
"""Largest change per px of the brightness, of the background's, inside a shadow: noise is half of
it. At .03 noisy shadows are vehicles; at .06 half the dark cars of a cloudy day are shadows."""
_RIM = np.ones((5, 5), np.uint8)
"""Surroundings of a change's pixel, px, that have to have changed, too, for an edge there to count:
blur and slope reach over two pixels to each side."""
_SPARSE = (slice(None), slice(None, None, 4), slice(None, None, 4))
"""Pixels that the camera's gain is taken from: one in sixteen is enough for a median."""
_ADOPTED = 1.05
"""Change of the camera's gain, either way, above which the background takes the image's exposure. A
choice: several times the noise of the median, so that roundings of the samples do not add up."""
_MOST_GAIN = 1.3
"""Largest change of the gain, either way, that is undone where no change of exposure explains the
image. A choice; beyond it the light was switched."""
_NEIGHBOURS = ((-1, 0), (1, 0), (0, -1), (0, 1))
"""Steps (rows, columns) to the four neighbours that a sample may be given to."""
_FORGIVEN = 0.1
"""Images of change that an image without any makes up for: behind one vehicle in ten images there
is still a road to be learnt, and leaves that move in more of them are background in the end."""
_STANDS = 0.2
"""Mean time, s, for which a part has been changed before it is taken for a hole: of what drives by
fast edges are blurred."""
_AGAIN = 0.5
"""Share of a hole that the search before has found to be one, too: most of it."""
_AROUND = np.ones((7, 7), np.uint8)
"""Surroundings of a change that are not learnt either: the rim of a vehicle that is not told from
the road would be given on to its neighbours, and eat into it."""


class Background:
    """Samples of the colours of every pixel.

    Parameters
    ----------
    shape : (int, ...)
        Shape of the images.
    seed : int
        Seed of the choice of the samples.
    thresholds : MotionThresholds
        Thresholds.
    """

    def __init__(self, shape: tuple[int, ...], seed: int, thresholds: MotionThresholds) -> None:
        self._thresholds = thresholds
        self._rng = np.random.default_rng(seed)
        # One image of noise, read from another place each time, is cheaper than new noise.
        self._noise = self._rng.integers(0, 256, 2 * shape[0] * shape[1], dtype=np.uint8)
        self._samples: list[Planes] = []
        self._age = 0
        self._exposure = np.zeros(shape[:2], dtype=np.float32)
        self._suspected = np.zeros(shape[:2], dtype=np.uint8)

    @property
    def is_known(self) -> bool:
        """Test whether there are as many samples as it takes."""
        return len(self._samples) == _SAMPLES

    def begin(self, image: Colours, period: float) -> None:
        """Take one of the first images, which are `period` s apart."""
        if period >= _SAMPLE_INTERVAL or self._age % _BETWEEN == 0:
            self._samples.append(_planes(image))
        self._age += 1

    def compare(self, image: Colours) -> Pixels:
        """Mark the pixels that have changed and are not just in a shadow."""
        # Gain first: it changes every pixel. Shadows last, and only among what has changed.
        planes = self._of_one_exposure(_planes(image))
        changed = self._unlike(planes)
        return np.asarray(changed & ~self._shadows(planes, changed))

    def _unlike(self, planes: Planes) -> Pixels:
        """Mark the pixels whose colour too few samples have."""
        # A whole number, as levels are: with a fraction all of them would be compared as floats.
        limit = math.ceil(self._thresholds.colour_threshold)
        height = len(planes) // 3
        width = planes.shape[1]
        # Two rounds: few samples of all pixels, and the others of the few that are still in doubt.
        agreeing = np.zeros((height, width), np.uint8)
        for sample in self._samples[:_LOOKED_AT]:
            agreeing += _sum(cv2.absdiff(planes, sample)) < limit
        # Most pixels are background by then; the further samples are compared at the others.
        index = np.flatnonzero(agreeing < _AGREEING)
        if not len(index):
            return np.zeros((height, width), np.bool_)
        colours = np.take(planes.reshape(3, -1), index, axis=1)
        few = agreeing.ravel()[index]
        for sample in self._samples[_LOOKED_AT:]:
            apart = cv2.absdiff(colours, np.take(sample.reshape(3, -1), index, axis=1))
            few += apart.sum(axis=0, dtype=np.uint16) < limit
        agreeing.ravel()[index] = few
        return np.asarray(agreeing < _AGREEING)

    def learn(self, image: Colours, changed: Pixels, held: Pixels, period: float) -> None:
        """Renew samples, but where something has changed lately or is held.

        Parameters
        ----------
        image : (H, W, 3) array
            The image.
        changed, held : (H, W) arrays
            Pixels that differ from the background, and those of followed vehicles.
        period : float
            Time that the image stands for, s.
        """
        # 1. How long each pixel has lately been covered, by images: their sums are whole, and the
        # bound is met in the same one on any machine.
        patience = self._thresholds.patience / period
        self._exposure += np.where(changed, np.float32(1), np.float32(-_FORGIVEN))
        # Bounded: where a queue stood for long, what drives by would else be learnt for hours.
        np.clip(self._exposure, 0, 2 * patience, out=self._exposure)
        # 2. Learn what has not changed, or has for so long that it belongs to the scene; never
        # where a followed vehicle stands.
        near = cv2.dilate(changed.astype(np.uint8), _AROUND) > 0
        learnt = ~(held | (near & (self._exposure < patience)))
        self._age += 1
        planes = _planes(image)
        # 3. One sample in turn, so that all are renewed alike.
        _give(planes, learnt & self._some(learnt.shape), self._samples[self._age % _SAMPLES])
        # 4. Another one takes a neighbour's colour: uncovered road spreads into what had a vehicle
        # in its first samples.
        other = self._samples[int(self._rng.integers(_SAMPLES))]
        chosen = learnt & self._some(learnt.shape)
        _give(planes, chosen, other, _NEIGHBOURS[int(self._rng.integers(len(_NEIGHBOURS)))])

    def holes(self, image: Colours, changed: Mask, period: float) -> Mask:
        """Mark the parts of a change that are holes of vehicles which have left, and learn them.

        Parameters
        ----------
        image : (H, W, 3) array
            The image.
        changed : (H, W) array
            Not 0 where it has changed.
        period : float
            Time that the image stands for, s.

        Returns
        -------
        (H, W) array
            1 in holes.
        """
        suspected = np.zeros(changed.shape, np.uint8)
        found = np.zeros(changed.shape, np.uint8)
        for section, part in standing_parts(changed, self._exposure, _STANDS / period):
            if not is_hole(image[section][..., 1], self._green(section), part):
                continue
            suspected[section] |= part
            # Twice: by chance once in a hundred, and what drives is elsewhere by then.
            if cv2.mean(self._suspected[section], part)[0] > _AGAIN:
                found[section] |= part
        self._suspected = suspected
        if found.any():
            self._relearn(image, cv2.dilate(found, _AROUND) > 0)
        return found

    def _green(self, section: Section) -> npt.NDArray[np.float32]:
        """Levels of green in a section, which are most of the brightness."""
        height = len(self._samples[0]) // 3
        rows, columns = section
        green = (slice(rows.start + height, rows.stop + height), columns)
        samples = self._samples[::_COMPARED]
        levels = samples[0][green].astype(np.float32)
        for sample in samples[1:]:
            levels += sample[green]
        return np.asarray(levels / len(samples), np.float32)

    def _relearn(self, image: Colours, uncovered: Pixels) -> None:
        """Learn at once what was uncovered."""
        planes = _planes(image)
        for sample in self._samples:
            _give(planes, uncovered, sample)
        self._exposure[uncovered] = 0

    def _of_one_exposure(self, planes: Planes) -> Planes:
        """Undo a small change of the camera's gain, and give the background a large one's.

        Something white that drives by lowers the gain for a moment. What is covered by vehicles, or
        cut off in white, could not be learnt anew: the samples change as the image has.
        """
        gain = self._gain(planes)
        if not 1 / _ADOPTED < gain < _ADOPTED:
            curves = exposure_change(*(_sparse(one) for one in (self._samples[0], planes)))
            if curves is not None:
                self._samples = [_with_curves(one, curves) for one in self._samples]
                gain = self._gain(planes)
        if not 1 / _MOST_GAIN < gain < _MOST_GAIN:
            return planes
        return np.asarray(cv2.convertScaleAbs(planes, alpha=1 / gain), np.uint8)

    def _gain(self, planes: Planes) -> float:
        """Median ratio of the image to the background, as vehicles change some of the pixels."""
        before, now = (
            one.reshape(3, -1, one.shape[1])[_SPARSE].sum(axis=0, dtype=np.float32)
            for one in (self._samples[0], planes)
        )
        lit = before > self._thresholds.colour_threshold  # darker ones are noise
        return float(np.median(now[lit] / before[lit])) if lit.any() else 1.0

    def _some(self, shape: tuple[int, ...]) -> Pixels:
        """Choose as many pixels at random as are renewed in an image."""
        size = shape[0] * shape[1]
        start = int(self._rng.integers(size))
        # One of `_SAMPLES` has its turn in an image, hence the factor.
        few = self._noise[start : start + size] < 256 * _SAMPLES // _RENEWED
        return np.asarray(few.reshape(shape))

    def _shadows(self, planes: Planes, changed: Pixels) -> Pixels:
        """Find pixels that have the background's colour, but darker, and none of their own edges.

        The inside of a shadow shows the road as it is, at one brightness; a dark vehicle has
        windows, lights and edges. The rim of a change has an edge in either case.
        """
        # 1. Only where something has changed: the rest is no vehicle already.
        index = np.flatnonzero(changed)
        if not len(index):
            return changed
        colours = np.take(planes.reshape(3, -1), index, axis=1).astype(np.float32)
        background = np.zeros_like(colours)
        for sample in self._samples[::_COMPARED]:
            cv2.accumulate(np.take(sample.reshape(3, -1), index, axis=1), background)
        background /= len(self._samples[::_COMPARED])
        # 2. Project each colour on the background's: the share is brightness, the rest another
        # colour.
        power = np.maximum((background**2).sum(axis=0), 1)
        share = (colours * background).sum(axis=0) / power
        apart = (colours**2).sum(axis=0) - share**2 * power
        # 3. Darker, but not too dark, and of the same colour.
        shares = np.ones(changed.shape, np.float32)
        dark = np.zeros(changed.shape, np.bool_)
        shares.flat[index] = share
        dark.flat[index] = (self._thresholds.shadow <= share) & (share <= 1)
        dark.flat[index] &= apart < (_SHADE * share) ** 2
        # 4. Brightness that changes from pixel to pixel is an edge. Smoothed before, as noise has
        # slopes, too.
        smooth = cv2.blur(shares, (3, 3))
        slope = cv2.magnitude(
            cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=1 / 8),
            cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=1 / 8),
        )
        # 5. Edges count inside a change only: its own rim is one.
        inner = cv2.erode(changed.astype(np.uint8), _RIM) > 0
        return np.asarray(dark & ~(inner & (slope > _EDGE)))


def _planes(image: Colours) -> Planes:
    return np.ascontiguousarray(np.concatenate(cv2.split(image)), np.uint8)


def _sum(planes: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Add the channels; bytes end at 255, far above every threshold."""
    height = len(planes) // 3
    first = planes[:height]
    second = planes[height : 2 * height]
    third = planes[2 * height :]
    return np.asarray(cv2.add(cv2.add(first, second), third), planes.dtype)


def _sparse(planes: Planes) -> npt.NDArray[np.float64]:
    """Levels (3, N) of a few pixels."""
    few = planes.reshape(3, -1, planes.shape[1])[_SPARSE]
    return np.asarray(few.reshape(3, -1), np.float64)


def _with_curves(planes: Planes, curves: Curves) -> Planes:
    parts = [cv2.LUT(*each) for each in zip(np.split(planes, 3), curves, strict=True)]
    return np.ascontiguousarray(np.concatenate(parts), np.uint8)


def _give(planes: Planes, chosen: Pixels, sample: Planes, offset: tuple[int, int] = (0, 0)) -> None:
    """Give the colours of chosen pixels to a sample, there or of their neighbours on one side."""
    # Views shifted against each other: the neighbour's old colour is overwritten without a loop.
    dy, dx = offset
    height, width = chosen.shape
    rows = slice(max(-dy, 0), height - max(dy, 0))
    columns = slice(max(-dx, 0), width - max(dx, 0))
    mask = chosen[rows, columns].astype(np.uint8)
    for new, old in zip(np.split(planes, 3), np.split(sample, 3), strict=True):
        part = old[max(dy, 0) : height - max(-dy, 0), max(dx, 0) : width - max(-dx, 0)]
        cv2.copyTo(new[rows, columns], mask, part)
