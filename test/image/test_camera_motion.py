"""Motion of the camera, also with a lorry in the view."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image import camera_motion
from vehicle_pf_tracker.image.camera_motion import CameraFlow, CameraMotion, fit_camera_motion
from vehicle_pf_tracker.image.small_grey import SmallGrey, small_grey

RNG = np.random.default_rng(5)
TEXTURE = cv2.GaussianBlur(RNG.integers(0, 255, (400, 500, 3)).astype(np.uint8), (0, 0), 2)
NOWHERE = Box(-50, -50, 1, 1)


def view(x, y, lorry=None):
    frame = np.ascontiguousarray(TEXTURE[50 + y : 290 + y, 50 + x : 370 + x])
    if lorry is not None:
        frame[40:200, lorry : lorry + 120] = TEXTURE[:160, :120][::-1]
    return frame


def seen(x, y, lorry=None):
    return small_grey(view(x, y, lorry))


def corners():
    return np.random.default_rng(1).uniform(0, 300, (40, 2))


def test_shift_and_scale_are_recovered():
    before = corners()
    motion = fit_camera_motion(before, 1.02 * before + [4.0, -3.0])
    assert motion.scale == pytest.approx(1.02)
    assert motion.shift == pytest.approx((4.0, -3.0))
    assert motion.apply(before) == pytest.approx(1.02 * before + [4.0, -3.0])


def test_corners_on_other_vehicles_take_no_part():
    before = corners()
    after = before + np.array([5.0, 0.0])
    after[:12] += [-9.0, 2.0]
    motion = fit_camera_motion(before, after)
    assert motion.shift == pytest.approx((5.0, 0.0))


def test_a_lorry_that_moves_most_corners_does_not_move_the_camera():
    before = corners()
    after = before.copy()
    after[:24] += [6.0, 1.0]
    assert fit_camera_motion(before, after).still


def test_too_few_corners_say_nothing():
    assert fit_camera_motion(corners()[:3], corners()[:3] + 9).still


@pytest.mark.parametrize(("x", "y"), [(3, -2), (-12, 7), (20, 0)])
def test_the_flow_of_a_shifted_view_is_its_shift(x, y):
    flow = CameraFlow()
    assert flow.measure(seen(0, 0), NOWHERE) == CameraMotion()
    motion = flow.measure(seen(x, y), NOWHERE)
    assert motion.shift == pytest.approx((-x, -y), abs=0.5)
    assert motion.scale == pytest.approx(1.0, abs=0.005)


def test_a_lorry_that_passes_does_not_disturb_the_flow():
    flow = CameraFlow()
    flow.measure(seen(0, 0, lorry=60), NOWHERE)
    motion = flow.measure(seen(4, 2, lorry=67), NOWHERE)
    assert motion.shift == pytest.approx((-4, -2), abs=0.5)


def test_a_standing_camera_is_still_while_a_lorry_passes():
    flow = CameraFlow()
    flow.measure(seen(0, 0, lorry=60), NOWHERE)
    assert flow.measure(seen(0, 0, lorry=67), NOWHERE).still


def test_tiny_and_changed_images_are_borne():
    flow = CameraFlow()
    tiny = np.zeros((3, 4, 3), np.uint8)
    assert flow.measure(small_grey(tiny), NOWHERE).still
    assert flow.measure(small_grey(tiny), NOWHERE).still
    assert flow.measure(seen(0, 0), NOWHERE).still


def test_a_mounted_camera_is_measured_seldom_and_its_jump_at_once(monkeypatch):
    flow, tracked = CameraFlow(), []
    track = camera_motion._track
    monkeypatch.setattr(
        camera_motion, "_track", lambda *images: tracked.append(1) or track(*images)
    )
    noise = np.random.default_rng(2)
    for _ in range(90):
        shown = seen(0, 0)
        noisy = np.clip(shown.image + noise.normal(0, 1.5, shown.image.shape), 0, 255)
        assert flow.measure(SmallGrey(noisy.astype(np.uint8), shown.zoom), NOWHERE).still
    assert 30 <= len(tracked) <= 50
    jump = flow.measure(seen(5, -3), NOWHERE)
    assert jump.shift == pytest.approx((-5, 3), abs=0.3)
