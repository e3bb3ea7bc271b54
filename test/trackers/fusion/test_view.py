"""Maps that are read between their entries."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.region import Region
from vehicle_pf_tracker.trackers.fusion.view import View

SCALES = np.array([0.5, 1.0, 2.0])


def view(fused, zoom=1.0, origin=(10.0, 20.0)):
    height, width = fused.shape[1:]
    blank = np.zeros((height, width, 3), np.uint8)
    region = Region(blank, blank[..., 0], origin, (zoom, zoom))
    scales = SCALES if len(fused) == 3 else np.ones(1)
    return View(region, scales, fused[np.newaxis], fused)


def ramp():
    """A map whose entry is ``100 s + 10 r + c``."""
    s, r, c = np.mgrid[0:3, 0:6, 0:8]
    return (100 * s + 10 * r + c).astype(np.float32)


def test_the_middle_of_a_pixel_is_its_entry():
    one = view(ramp())
    assert one.read(one.fused, np.array([[13.5, 22.5]]), np.ones(1)) == pytest.approx([123.0])


def test_between_entries_and_sizes_it_is_linear():
    one = view(ramp())
    at = np.array([[13.75, 22.75]])
    assert one.read(one.fused, at, np.array([2**0.5])) == pytest.approx([175.75], abs=1e-4)


def test_sizes_beyond_the_maps_read_the_nearest():
    one = view(ramp())
    at = np.array([[13.5, 22.5]] * 2)
    assert one.read(one.fused, at, np.array([0.1, 9.0])) == pytest.approx([23.0, 223.0])


def test_beyond_the_region_nothing_is_alike():
    one = view(ramp() + 1)
    outside = np.array([[9.9, 22.0], [18.1, 22.0], [13.0, 19.9], [13.0, 26.1]])
    assert (one.read(one.fused, outside, np.ones(4)) == 0).all()
    assert one.read(one.fused, np.array([[10.1, 20.1]]), np.ones(1))[0] > 0


def test_one_size_and_several_maps_at_once():
    one = view(ramp()[:1])
    several = np.stack([one.fused, 2 * one.fused])
    assert one.read(several, np.array([[12.5, 20.5]]), np.ones(1)) == pytest.approx(
        np.array([[2.0], [4.0]])
    )


def bump(place, shape=(3, 40, 40)):
    """A hill at a place (u, v) of the middle size."""
    v, u = np.mgrid[0 : shape[1], 0 : shape[2]] + 0.5
    fused = np.zeros(shape, np.float32)
    fused[1] = np.exp(-((u - place[0]) ** 2 + (v - place[1]) ** 2) / 18)
    return fused


def test_refinement_climbs_to_the_peak_between_pixels():
    one = view(bump((21.3, 17.8)), zoom=2.0)
    x, y = one.refine((10 + 19 / 2, 20 + 16 / 2), 1.0)
    assert (x, y) == pytest.approx((10 + 21.3 / 2, 20 + 17.8 / 2), abs=0.1)


def test_refinement_at_the_border_stays_where_it_is_known():
    one = view(bump((1.0, 1.0)))
    x, y = one.refine((10.0, 20.0), 1.0)
    assert 10 <= x < 14
    assert 20 <= y < 24


def test_the_best_place_is_the_peak_unless_it_is_far_off_or_beyond_the_image():
    two = bump((30.5, 20.5)) + 0.9 * bump((10.5, 20.5))
    one = view(two)
    assert one.best((20.0, 40.0), 1e6, (200, 200)).place == pytest.approx((40.5, 40.5))
    near = one.best((20.0, 40.0), 10.0, (200, 200))
    assert near.place == pytest.approx((20.5, 40.5))
    assert near.scale == 1.0
    assert one.best((20.0, 40.0), 1e6, (35, 200)).place == pytest.approx((20.5, 40.5))
