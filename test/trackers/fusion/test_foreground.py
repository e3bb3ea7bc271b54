"""What stands out from a still camera's background."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.fusion.foreground import Foreground, Span, around, joined

STREET = np.random.default_rng(0).integers(90, 100, (80, 160, 3), dtype=np.uint8)
WHOLE = Span(0, 0, 160, 80)


def street(*places, level=0):
    """Vehicles of 20x10 px around each x of `places`, on a street that is `level` brighter."""
    frame = STREET + np.uint8(level)
    for x in places:
        frame[35:45, x - 10 : x + 10] = 200
    return frame


def box(x):
    return Box.around((float(x), 40.0), 20.0, 10.0)


def learnt():
    """A background that a vehicle has driven over."""
    foreground = Foreground(street(30), box(30))
    for x in range(30, 100, 5):
        foreground.learn(street(x), box(x))
    return foreground


def test_a_vehicle_is_one_blob_with_its_edges_area_and_colours():
    (blob,) = learnt().blobs(street(100), WHOLE, 20.0)
    assert blob.edges.tolist() == [90, 35, 110, 45]
    assert blob.area == 200
    assert blob.centre == (100, 40)
    assert blob.size == (20, 10)
    assert blob.pixels.shape == (200, 1, 3)
    assert (blob.pixels == 200).all()


def test_small_ones_do_not_count_and_several_do():
    found = learnt().blobs(street(60, 120), WHOLE, 20.0)
    assert sorted(one.centre[0] for one in found) == [60, 120]
    assert learnt().blobs(street(60), WHOLE, 201.0) == []
    assert learnt().blobs(street(60), Span(50, 35, 53, 45), 1.0) == []


def test_what_the_target_stood_before_is_unknown_until_it_has_left():
    foreground = Foreground(street(30), box(30))
    assert not foreground.knows(around(street(30), box(30), 0.0))
    for x in (30, 40, 60, 80):
        foreground.learn(street(x), box(x))
    assert foreground.knows(WHOLE)
    assert foreground.blobs(street(), WHOLE, 20.0) == []


def test_slow_changes_of_the_light_are_followed_away_from_the_target():
    foreground = learnt()
    for level in range(40):
        for _ in range(8):
            foreground.learn(street(120, level=level), box(120))
    (blob,) = foreground.blobs(street(120, level=40), WHOLE, 20.0)
    assert blob.edges.tolist() == pytest.approx([110, 35, 130, 45], abs=10)
    assert all(one.centre[0] > 80 for one in foreground.blobs(street(level=40), WHOLE, 5.0))


def test_large_windows_are_looked_at_with_fewer_pixels():
    large = np.full((600, 800, 3), 90, np.uint8)
    foreground = Foreground(large, Box(0, 0, 5, 5))
    seen = large.copy()
    seen[200:260, 300:420] = 200
    (blob,) = foreground.blobs(seen, Span(0, 0, 800, 600), 100.0)
    assert blob.edges.tolist() == pytest.approx([300, 200, 420, 260], abs=6)
    assert blob.area == pytest.approx(60 * 120, rel=0.1)
    assert len(blob.pixels) < 600


def test_joined_blobs_have_the_edges_of_all():
    both = joined(learnt().blobs(street(60, 120), WHOLE, 20.0))
    assert both.edges.tolist() == [50, 35, 130, 45]
    assert both.area == 400
    assert len(both.pixels) == 400


def test_frames_of_another_size_do_not_fit():
    assert learnt().fits(street())
    assert not learnt().fits(street()[:40])


def test_boxes_are_cut_at_the_border():
    assert around(street(), Box(-5, 70, 20, 20), 0.5) == Span(0, 60, 26, 80)
