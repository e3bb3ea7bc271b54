"""Regions at canonical size."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.region import cut_region


def ramp(width=60, height=40):
    frame = np.zeros((height, width, 3), np.uint8)
    frame[:] = (np.arange(width) * 4)[np.newaxis, :, np.newaxis]
    return frame


@pytest.mark.parametrize("zoom", [0.5, 1.0, 2.0])
def test_a_region_has_the_size_asked_for(zoom):
    region = cut_region(ramp(), (30.0, 20.0), (20.0, 10.0), zoom)
    assert region.grey.shape == (round(10 * zoom), round(20 * zoom))
    assert region.origin == (20.0, 15.0)
    assert region.zoom == (zoom, zoom)


def test_places_go_there_and_back():
    region = cut_region(ramp(), (30.3, 20.7), (17.0, 9.0), 1.7)
    places = np.array([[30.0, 20.0], [25.5, 18.25]])
    assert region.to_frame(region.to_canonical(places)) == pytest.approx(places)


def test_what_is_seen_at_a_place_is_what_the_frame_has_there():
    region = cut_region(ramp(), (30.0, 20.0), (20.0, 10.0), 2.0)
    x, y = region.to_canonical(np.array([30.0, 20.0]))
    # Column x of the frame has grey level 4 x at its centre x + 0.5.
    assert region.grey[int(y), int(x)] == pytest.approx(4 * 29.5, abs=2)


def test_beyond_the_border_the_outermost_pixels_are_repeated():
    region = cut_region(ramp(), (0.0, 20.0), (20.0, 10.0), 1.0)
    assert (region.grey[:, :10] == 0).all()
    far = cut_region(ramp(), (500.0, 500.0), (20.0, 10.0), 1.0)
    assert (far.grey == 4 * 59).all()
