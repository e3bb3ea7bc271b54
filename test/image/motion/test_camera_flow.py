# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion of the camera, also with a lorry in the view."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.motion.camera_flow import CameraFlow, fit_camera_motion
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey, small_grey

RNG = np.random.default_rng(5)
TEXTURE = cv2.GaussianBlur(RNG.integers(0, 255, (400, 500, 3)).astype(np.uint8), (0, 0), 2)
NOWHERE = Box(-50, -50, 1, 1)
MIDDLE = np.array([160.0, 120.0])


def view(x, y, lorry=None):
    frame = np.ascontiguousarray(TEXTURE[50 + y : 290 + y, 50 + x : 370 + x])
    if lorry is not None:
        frame[40:200, lorry : lorry + 120] = TEXTURE[:160, :120][::-1]
    return frame


def seen(x, y, lorry=None):
    return small_grey(view(x, y, lorry))


def corners():
    return np.random.default_rng(1).uniform(0, 300, (40, 2))


def turned(degrees, scale):
    """Rotation times scale."""
    cos, sin = scale * np.cos(np.radians(degrees)), scale * np.sin(np.radians(degrees))
    return np.array([[cos, -sin], [sin, cos]])


@pytest.mark.parametrize(("degrees", "scale"), [(0.0, 1.0), (0.0, 1.02), (1.0, 1.0), (-1.5, 0.98)])
def test_a_similarity_is_recovered(degrees, scale):
    before, turn = corners(), turned(degrees, scale)
    after = (before - 150) @ turn.T + [156.0, 146.0]
    motion = fit_camera_motion(before, after)
    assert motion.turn == pytest.approx(turn, abs=1e-6)
    assert motion.apply(before) == pytest.approx(after, abs=1e-4)
    assert motion.apply_to_velocities(np.array([2.0, -1.0])) == pytest.approx(turn @ [2.0, -1.0])


@pytest.mark.parametrize(("degrees", "scale"), [(0.0, 1.0), (1.0, 1.02)])
def test_corners_on_other_vehicles_take_no_part(degrees, scale):
    """Thirty in a hundred move otherwise, alike or each by itself."""
    rng = np.random.default_rng(8)
    before, turn = rng.uniform(0, 300, (100, 2)), turned(degrees, scale)
    true = (before - 150) @ turn.T + [155.0, 150.0]
    for moved in (np.array([-9.0, 2.0]), rng.uniform(-20, 20, (30, 2))):
        after = true + rng.normal(0, 0.1, (100, 2))
        after[:30] += moved
        motion = fit_camera_motion(before, after)
        assert motion.turn == pytest.approx(turn, abs=2e-3)
        assert motion.apply(before) == pytest.approx(true, abs=0.3)


def test_a_lorry_that_moves_many_corners_does_not_move_the_camera():
    before = corners()
    after = before.copy()
    after[:19] += [6.0, 1.0]
    assert fit_camera_motion(before, after).still


def test_too_few_corners_say_nothing():
    assert fit_camera_motion(corners()[:3], corners()[:3] + 9).still


@pytest.mark.parametrize(("x", "y"), [(3, -2), (-12, 7), (20, 0)])
def test_the_flow_of_a_shifted_view_is_its_shift(x, y):
    flow = CameraFlow()
    assert flow.measure(seen(0, 0), NOWHERE).still
    motion = flow.measure(seen(x, y), NOWHERE)
    assert motion.apply(MIDDLE) - MIDDLE == pytest.approx([-x, -y], abs=0.5)
    assert motion.turn == pytest.approx(np.eye(2), abs=0.01)


def test_a_turning_and_zooming_view_is_measured_in_px_of_the_whole_frame():
    large = cv2.resize(view(0, 0), (640, 480), interpolation=cv2.INTER_CUBIC)
    turn, middle = turned(1.0, 1.01), np.array([320.0, 240.0])
    matrix = np.column_stack([turn, middle - turn @ middle + [6.0, -4.0]])
    flow = CameraFlow()
    flow.measure(small_grey(large), NOWHERE)
    motion = flow.measure(small_grey(cv2.warpAffine(large, matrix, (640, 480))), NOWHERE)
    assert motion.turn == pytest.approx(turn, abs=3e-3)
    assert motion.apply(middle) - middle == pytest.approx([6.0, -4.0], abs=0.8)


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


def test_a_view_without_corners_is_searched_after_fifteen_frames_and_then_followed(monkeypatch):
    flow, searched = CameraFlow(), []
    search = cv2.cornerMinEigenVal
    monkeypatch.setattr(
        cv2, "cornerMinEigenVal", lambda *a, **k: searched.append(1) or search(*a, **k)
    )
    bare = small_grey(np.full((240, 320, 3), 90, np.uint8))
    flow.measure(bare, NOWHERE)
    # Searched at once, and then when it has aged by five frames: one, and a third in each.
    for _ in range(28):
        assert flow.measure(bare, NOWHERE).still
    assert len(searched) == 2
    # Corners that come are found by the next search, and their motion is measured from then on.
    for _ in range(15):
        flow.measure(seen(0, 0), NOWHERE)
    motion = flow.measure(seen(3, -2), NOWHERE)
    assert motion.apply(MIDDLE) - MIDDLE == pytest.approx([-3, 2], abs=0.5)


def test_a_mounted_camera_is_measured_seldom_and_its_jump_at_once(monkeypatch):
    flow, tracked = CameraFlow(), []
    track = cv2.calcOpticalFlowPyrLK
    monkeypatch.setattr(
        cv2, "calcOpticalFlowPyrLK", lambda *a, **k: tracked.append(1) or track(*a, **k)
    )
    noise = np.random.default_rng(2)
    for _ in range(90):
        shown = seen(0, 0)
        noisy = np.clip(shown.image + noise.normal(0, 1.5, shown.image.shape), 0, 255)
        assert flow.measure(SmallGrey(noisy.astype(np.uint8), shown.zoom), NOWHERE).still
    assert 30 <= len(tracked) <= 50
    jump = flow.measure(seen(5, -3), NOWHERE)
    assert jump.apply(MIDDLE) - MIDDLE == pytest.approx([-5, 3], abs=0.3)
