# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shadows, and edges that the background has not.

Another light shows the road as it is, darker or brighter, and has no edges of its own; a vehicle
has windows, lights and an outline.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

Planes = npt.NDArray[np.uint8]
"""Channels of an image, one below the other: sums over them are ten times as fast."""
Pixels = npt.NDArray[np.bool_]
Values = npt.NDArray[np.float32]

_SHADE = 20.0
"""Largest distance in colour of a shadow from the darkened background."""
_COMPARED = 3
"""Every this many of the samples make the background that light is told by: a mean is enough."""
_EDGE = 0.04
"""Largest change per px of the brightness, of the background's, inside a shadow: noise is half of
it. At .03 noisy shadows are vehicles; at .06 half the dark cars of a cloudy day are shadows."""
_RIM = np.ones((5, 5), np.uint8)
"""Surroundings of a change's pixel that have to have changed, too, for an edge there to count."""


def shadows_and_edges(
    planes: Planes, samples: Sequence[Planes], changed: Pixels, darkest: float
) -> tuple[Pixels, Values]:
    """Find changed pixels that are in a shadow, and the strength of edges at changed pixels.

    An edge is one of the image and of its difference to the background: not one of the road that a
    lamp lights, nor of a vehicle that stood there while the background was learnt.

    Parameters
    ----------
    planes : (3 H, W) array
        Channels of the image.
    samples : sequence of (3 H, W) array
        Earlier colours of the background.
    changed : (H, W) array
        True where the image differs from the background.
    darkest : float
        Least brightness of a shadow, of the background's.

    Returns
    -------
    shadows : (H, W) array
        True at changed pixels that are in a shadow.
    edges : (H, W) array
        Strength of the edges, levels per px; 0 where nothing has changed.
    """
    index = np.flatnonzero(changed)
    if not len(index):
        return changed, changed.astype(np.float32)
    background = np.zeros(planes.shape, np.float32)
    for sample in samples[::_COMPARED]:
        cv2.accumulate(sample, background)
    background /= len(samples[::_COMPARED])
    edges = _new_edges(planes, background)
    edges[~changed] = 0
    colours = np.take(planes.reshape(3, -1), index, axis=1).astype(np.float32)
    road = np.take(background.reshape(3, -1), index, axis=1)
    return _shadows(colours, road, changed, index, darkest), edges


def _new_edges(planes: Planes, background: Values) -> Values:
    """Measure edges both of the image and of its difference to the background, levels per px."""
    image, road = _added(planes), _added(background)
    difference = np.asarray(cv2.subtract(image, road), np.float32)
    # A third of the sum: levels of one channel.
    return np.asarray(np.minimum(_slope(image, 1 / 3), _slope(difference, 1 / 3)), np.float32)


def _added(planes: npt.NDArray[Any]) -> Values:
    """Add the channels."""
    height = len(planes) // 3
    first, second, third = planes[:height], planes[height : 2 * height], planes[2 * height :]
    both = cv2.add(first, second, dtype=cv2.CV_32F)
    return np.asarray(cv2.add(both, third, dtype=cv2.CV_32F), np.float32)


def _shadows(
    colours: Values,
    background: Values,
    changed: Pixels,
    index: npt.NDArray[np.intp],
    darkest: float,
) -> Pixels:
    """Find pixels that have the background's colour, but darker, and none of their own edges.

    The inside of a shadow shows the road as it is, at one brightness. The rim of a change has an
    edge in either case.
    """
    power = np.maximum((background**2).sum(axis=0), 1)
    share = (colours * background).sum(axis=0) / power
    apart = (colours**2).sum(axis=0) - share**2 * power
    shares, dark = np.ones(changed.shape, np.float32), np.zeros(changed.shape, np.bool_)
    shares.flat[index] = share
    dark.flat[index] = (darkest <= share) & (share <= 1)
    dark.flat[index] &= apart < (_SHADE * share) ** 2
    inner = cv2.erode(changed.astype(np.uint8), _RIM) > 0
    slope = _slope(np.asarray(cv2.blur(shares, (3, 3)), np.float32))
    return np.asarray(dark & ~(inner & (slope > _EDGE)))


def _slope(values: Values, scale: float = 1.0) -> Values:
    """Measure the change per px, times a scale."""
    across = cv2.Sobel(values, cv2.CV_32F, 1, 0, scale=scale / 8)
    down = cv2.Sobel(values, cv2.CV_32F, 0, 1, scale=scale / 8)
    return np.asarray(cv2.magnitude(across, down), np.float32)
