"""What a still camera saw before."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.small_grey import SmallGrey
from vehicle_pf_tracker.trackers.fusion.background import Background

STREET = np.random.default_rng(0).integers(80, 110, (60, 160), dtype=np.uint8)


def shot(x, level=200):
    """A street with a vehicle of 20x10 px around (x, 30)."""
    image = STREET.copy()
    if x is not None:
        image[25:35, x - 10 : x + 10] = level
    return SmallGrey(image, 1.0)


def box(x):
    return Box.around((x, 30.0), 20.0, 10.0)


def driven(background=None):
    """A background after a drive from 20 to 100 px."""
    background = background or Background()
    for x in range(20, 104, 4):
        background.keep(shot(x), box(x))
    return background


def test_a_place_without_the_target_shows_the_background():
    background = driven()
    assert background.shows(shot(None), box(110))
    assert not background.shows(shot(110), box(110))


def test_the_change_is_that_since_the_target_stood_beside():
    assert driven().change(shot(None), box(130)) == 0
    expected = np.abs(200.0 - STREET[26:35, 102:119]).mean()
    assert driven().change(shot(110), box(110)) == pytest.approx(expected, rel=0.05)


def test_nothing_is_known_of_a_place_that_the_target_never_left():
    background = Background()
    for _ in range(10):
        background.keep(shot(50), box(50))
    assert background.change(shot(50), box(55)) is None
    assert not background.shows(shot(None), box(55))


def test_few_frames_and_a_camera_that_moved_tell_nothing():
    background = Background()
    for x in (20, 40, 60, 80, 100):
        background.keep(shot(x), box(x))
    assert background.change(shot(None), box(130)) is None
    background = driven()
    background.forget()
    assert not background.shows(shot(None), box(110))


def test_beyond_the_image_nothing_is_known():
    assert driven().change(shot(None), box(900)) is None
