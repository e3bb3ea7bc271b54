"""What the motion says of particles."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.history import Trend
from vehicle_pf_tracker.trackers.fusion.likelihood import Prior
from vehicle_pf_tracker.trackers.fusion.particles import Particles


def at(*places, scale=1.0):
    count = len(places)
    return Particles(
        np.array(places, float), np.zeros((count, 2)), np.full(count, scale), np.ones(count)
    )


def test_the_prediction_is_a_weak_prior():
    prior = Prior((50.0, 50.0), 20.0, None, 0.1)
    # 8 px are one standard deviation of 0.4 sizes.
    assert prior.log(at((50, 50), (58, 50), (50, 66))) == pytest.approx([0, -0.5, -2])


def test_in_doubt_the_trend_holds_place_and_scale():
    prior = Prior((50.0, 50.0), 20.0, Trend.still((50.0, 50.0), 1.0), 0.01)
    # 4 px are one standard deviation of 0.2 sizes, and half of one of the prediction.
    assert prior.log(at((54, 50))) == pytest.approx([-0.5 - 0.125])
    assert prior.log(at((50, 50), scale=np.exp(0.05))) == pytest.approx([-0.5])


def test_a_motion_that_is_foretold_badly_holds_less():
    prior = Prior((50.0, 50.0), 20.0, Trend.still((50.0, 50.0), 1.0), 0.2)
    # Three innovations of 0.2 sizes are 12 px.
    assert prior.log(at((62, 50))) == pytest.approx([-0.5 - 1.125])
