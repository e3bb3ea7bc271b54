# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shadows, and edges that the background has not."""

import cv2
import numpy as np

from vehicle_pf_tracker.detection.illumination import shadows_and_edges

ROAD = np.full((60, 80, 3), 100, np.uint8)
ROAD[:, 38:42] = 190  # a line
CAR = (slice(20, 40), slice(10, 35))


def planes(image):
    return np.concatenate(cv2.split(image))


def seen(image, background=ROAD):
    """Changed pixels in shadow, and strength of the edges."""
    changed = np.abs(image.astype(int) - background).sum(axis=2) > 32
    return shadows_and_edges(planes(image), [planes(background)] * 10, changed, 0.6)


def with_car(brightness=30):
    image = ROAD.copy()
    image[CAR] = brightness
    return image


def test_without_a_change_there_is_neither():
    shadows, edges = seen(ROAD)
    assert not shadows.any()
    assert not edges.any()


def test_a_car_has_edges_around_it():
    _, edges = seen(with_car())
    assert edges[20, 12:33].min() > 25
    assert edges[25:35, 15:30].max() < 1


def test_a_place_that_a_car_has_left_has_none():
    _, edges = seen(ROAD, with_car())
    assert edges.max() < 1


def test_a_line_in_the_light_of_a_lamp_is_no_edge_of_its_own():
    across, down = np.meshgrid(np.arange(80), np.arange(60))
    lamp = 60 * np.exp(-(((across - 40) / 15) ** 2) - ((down - 30) / 15) ** 2)
    lit = np.clip(ROAD + lamp[..., np.newaxis], 0, 255).astype(np.uint8)
    shadows, edges = seen(lit)
    assert not shadows.any()
    assert edges.max() < 4


def test_a_smooth_shadow_is_one_and_a_dark_car_with_windows_is_not():
    image = ROAD.copy()
    image[15:45, 5:36] = image[15:45, 5:36] * 0.75
    shadows, _ = seen(image)
    assert shadows[20:40, 10:30].all()
    image[22:38, 12:30:4] = 20
    shadows, _ = seen(image)
    assert shadows[20:40, 10:30].mean() < 0.5
