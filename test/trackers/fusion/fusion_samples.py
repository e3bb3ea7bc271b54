# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Textures, pictures and trackers that the tests of `fusion` share."""

import cv2
import numpy as np

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.tracker import FusionTracker


def fusion(**values):
    """A tracker with these parameters, the others as shipped."""
    return FusionTracker(from_mapping(FusionParameters, values))


def texture(seed, width=320, height=240, blur=3.0, gain=6.0):
    noise = np.random.default_rng(seed).integers(0, 256, (height, width, 3)).astype(np.uint8)
    return contrasted(noise, blur, gain)


def contrasted(noise, blur=3.0, gain=6.0):
    """Make a texture of noise."""
    smooth = cv2.GaussianBlur(noise, (0, 0), blur).astype(float)
    return np.clip(gain * (smooth - 128) + 128, 0, 255).astype(np.uint8)


def driven(time):
    """A car of 64 x 30 px at 2 px per frame, whose left side is at 60 px in the first one."""
    picture = texture(1, blur=2.0, gain=3.0)
    left = 60 + 2 * time
    picture[100:130, left : left + 64] = texture(2, 64, 30, blur=2.0, gain=3.0)
    return picture


def grey_road(width, height):
    noise = np.random.default_rng(0).integers(60, 140, (height, width)).astype(np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 2.0)


def paste_turned(road, vehicle, centre, degrees):
    """A copy of `road` with a vehicle around `centre`, turned by so much."""
    picture, (height, width) = road.copy(), vehicle.shape[:2]
    matrix = cv2.getRotationMatrix2D(((width - 1) / 2, (height - 1) / 2), degrees, 1.0)
    matrix[:, 2] += np.array(centre) - (width / 2, height / 2)
    size = road.shape[1::-1]
    mask = cv2.warpAffine(np.full((height, width), 255, np.uint8), matrix, size)
    picture[mask > 127] = cv2.warpAffine(vehicle, matrix, size)[mask > 127]
    return picture
