"""What sightings foretell."""

import pytest

from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.history import History, Trend

STILL = CameraMotion()


def drive(count, *, speed=3.0, growth=1.0, then=()):
    """A history of `count` frames at `speed` px a frame, and of positions `then`."""
    history = History(30.0)
    for t in range(count):
        history.age(1.0, STILL)
        history.see((100.0 + speed * t, 50.0), growth**t)
    for x in then:
        history.age(1.0, STILL)
        history.see((x, 50.0), growth ** (count - 1))
    return history


def test_the_trend_goes_on():
    trend = drive(12).trend(0.0, projective=True).after(5.0)
    assert trend.now()[0] == pytest.approx((100 + 3 * 16, 50.0), abs=0.5)
    assert trend.velocity() == pytest.approx((3.0, 0.0), abs=0.1)


def test_few_sightings_foretell_nothing():
    assert drive(3).trend(0.0, projective=True) is None
    assert drive(6).trend(3.0, projective=True) is None


def test_the_latest_sightings_can_be_left_out():
    dragged = drive(20, then=[157.0, 157.0, 157.0, 157.0])
    late = dragged.trend(0.0, projective=True).now()[0]
    before = dragged.trend(4.0, projective=True).now()[0]
    assert before == pytest.approx((100 + 3 * 23, 50.0), abs=1.0)
    assert late[0] < 165


def test_a_camera_that_pans_takes_the_sightings_along():
    history = drive(12)
    history.age(1.0, CameraMotion((-10.0, 4.0)))
    assert history.trend(0.0, projective=True).now()[0] == pytest.approx((126.0, 54.0), abs=0.5)


def test_the_trend_itself_is_taken_along_and_still_stays():
    trend = Trend.still((5.0, 6.0), 2.0).carried(CameraMotion((1.0, 1.0), 2.0)).after(9.0)
    assert trend.now() == ((11.0, 13.0), 4.0)


def test_growth_is_measured_cautiously_and_bounded():
    assert drive(12, growth=1.01).growth() == pytest.approx(0.8 * 0.00995, abs=1e-4)
    assert drive(12, growth=1.1).growth() == pytest.approx(0.8 * 0.03)
    assert drive(7, growth=1.01).growth() == 0


def test_sizes_of_the_last_sightings_can_be_left_out():
    history = History(30.0)
    for t in range(30):
        history.age(1.0, STILL)
        history.see((100.0 + 3 * t, 50.0), 1.0 if t < 25 else 0.6)
    assert history.trend(0.0, projective=True, unsized=5.0).now()[1] == pytest.approx(1.0, abs=0.02)
    assert history.trend(0.0, projective=True).now()[1] < 0.95


def test_sightings_may_be_told_late():
    late = History(30.0)
    late.age(12.0, STILL)
    for t in range(12):
        late.see((100.0 + 3 * t, 50.0), 1.0, 11.0 - t)
    assert late.trend(0.0, projective=True).now()[0] == pytest.approx((133.0, 50.0), abs=0.5)


def test_another_shape_counts_scales_anew_and_few_sightings_are_kept():
    history = drive(20, growth=1.02)
    history.reshape(50.0)
    assert history.trend(0.0, projective=True).now()[1] == pytest.approx(1.0)
    history.keep(3)
    assert history.trend(0.0, projective=True) is None
