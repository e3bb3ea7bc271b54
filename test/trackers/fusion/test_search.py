"""The search for a hidden target."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.small_grey import small_grey
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.background import Background
from vehicle_pf_tracker.trackers.fusion.parameters import CueParameters
from vehicle_pf_tracker.trackers.fusion.search import Foretold, Search
from vehicle_pf_tracker.trackers.fusion.suspicion import Suspicion

SIZE = (30.0, 20.0)
EXTENT = 600**0.5
VEHICLE = np.random.default_rng(1).integers(0, 255, (5, 6, 3)).repeat(4, axis=0).repeat(5, axis=1)


def street(x):
    """A vehicle around (x, 60); none where x is None."""
    frame = np.random.default_rng(0).normal(100, 6, (120, 240, 1)).repeat(3, axis=2)
    if x is not None:
        frame[50:70, x - 15 : x + 15] = VEHICLE
    return np.clip(frame, 0, 255).astype(np.uint8)


def search(background=None):
    appearance = Appearance(street(60), (60.0, 60.0), SIZE, CueParameters())
    suspicion = Suspicion()
    view = appearance.look(street(60), (60.0, 60.0), 1.0, 10.0, (1.0,))
    suspicion.settle(appearance.compare(view, (60.0, 60.0), 1.0))
    return Search(appearance, suspicion, background or Background())


def foretold(x, width=1.0):
    return Foretold((float(x), 60.0), (4.0, 0.0), 1.0, EXTENT, width)


def look(one, x, where, **values):
    """One frame later: the vehicle is at x and was foretold at `where`."""
    settings = {"wide": True, "sizes": True, **values}
    one.age(1.0, CameraMotion())
    return one.look(street(x), small_grey(street(x)), foretold(where), **settings)


def test_a_vehicle_that_comes_back_as_foretold_is_proven_after_three_frames():
    one, proofs = search(), []
    for x in (100, 104, 108):
        look(one, x, x + 3)
        proofs.append(one.proof(foretold(x), 3))
    assert proofs[:2] == [None, None]
    assert proofs[2].links[-1].place == pytest.approx((108, 60), abs=0.7)
    assert proofs[2].velocity == pytest.approx((4.0, 0.0), abs=0.4)


def test_an_empty_street_proves_nothing():
    one = search()
    assert all(look(one, None, 100 + 4 * t) < 0.6 for t in range(20))
    assert one.proof(foretold(180), 3) is None


def test_it_widens_with_time_and_with_the_particles():
    near, late, wide = search(), search(), search()
    assert look(near, 180, 100) < 0.6
    for t in range(40):
        found = look(late, 180, 100 + t % 2)
    assert found > 0.9
    wide.age(1.0, CameraMotion())
    spread = foretold(100, width=40.0)
    assert wide.look(street(180), small_grey(street(180)), spread, wide=True, sizes=True) > 0.9


def test_without_width_only_the_foretold_place_is_looked_at():
    one = search()
    for _ in range(40):
        found = look(one, 150, 100, wide=False)
    assert found < 0.6


def test_what_stood_there_before_is_no_candidate():
    background = Background()
    for x in range(20, 70, 4):  # the twin at 170 has been there all the time
        scene = street(170)
        scene[50:70, x - 15 : x + 15] = 250
        background.keep(small_grey(scene), Box.around((float(x), 60.0), *SIZE))
    one = search(background)
    for _ in range(20):
        look(one, 170, 168)
        assert one.proof(foretold(168), 3) is None
