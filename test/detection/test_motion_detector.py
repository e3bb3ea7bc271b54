# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detection of what moves before a standing camera."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.blobs import BlobReader
from vehicle_pf_tracker.detection.motion_detector import MotionDetector

GROUND = np.random.default_rng(0).integers(90, 120, (120, 160, 3))
NOBODY = np.empty((0, 4))
PAINT = np.random.default_rng(1).integers(180, 250, (24, 36, 3))


def frames(count, seed=0):
    """An empty road, then from frame 30 on a vehicle that drives to the right by 3 px."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        image = GROUND + rng.integers(0, 5, GROUND.shape)
        left = 3 * (index - 30)
        if left >= 0:
            image[60:84, left : left + 36] = PAINT
        yield image.astype(np.uint8)


def test_a_moving_vehicle_is_one_box_where_it_is():
    detector = MotionDetector()
    found = [detector.detect(frame) for frame in frames(45)]
    assert all(len(one) == 0 for one in found[:30])
    assert found[-1].boxes == pytest.approx(np.array([[42, 60, 36, 24]]), abs=3)
    assert found[-1].usable(*GROUND.shape[1::-1]).are_shapes


def test_a_shadow_is_cut_off_and_a_dark_vehicle_is_not():
    detector = MotionDetector()
    *before, last = frames(30)
    for frame in before:
        detector.detect(frame)
    last[60:84, 60:76] = last[60:84, 60:76] * 0.7  # of the paint, to its right
    last[60:84, 24:60] = PAINT
    dark = last[20:44, 100:136]
    dark[:] = dark * 0.8
    for top, bottom in ((3, 9), (16, 21)):  # its window and bumper
        dark[top:bottom, 3:33] = dark[top:bottom, 3:33] * 0.7
    found = detector.detect(last).boxes
    assert found[np.argsort(found[:, 0])] == pytest.approx(
        np.array([[24, 60, 36, 24], [100, 20, 36, 24]]), abs=4
    )


def test_nothing_is_found_where_nothing_changes():
    detector, still = MotionDetector(), GROUND.astype(np.uint8)
    assert all(len(detector.detect(still)) == 0 for _ in range(40))
    assert not detector.is_blind


def test_masks_repeat_whatever_else_the_process_draws():
    runs = []
    for _ in range(2):
        detector = MotionDetector()
        runs.append([detector.detect(frame).boxes.tolist() for frame in frames(45)])
    assert runs[0] == runs[1]


def read(image, predicted=(), velocities=(), reader=None):
    """Edges and fullness of the vehicles in a mask."""
    predicted, velocities = np.reshape(predicted, (-1, 4)), np.reshape(velocities, (-1, 2))
    return (reader or BlobReader()).read(image, predicted, velocities)[:2]


def mask(*boxes):
    image = np.zeros((120, 160), np.uint8)
    for left, top, right, bottom in boxes:
        image[top:bottom, left:right] = 255
    return image


def test_a_vehicle_that_is_followed_as_two_parts_stays_one_blob():
    parts = np.array([[20.0, 40, 46, 60], [34, 50, 60, 70]])
    edges, _ = read(mask((20, 40, 60, 70)), parts)
    assert edges.tolist() == [[20, 40, 60, 70]]


def test_pieces_of_one_vehicle_are_joined():
    predicted = np.array([[20.0, 40, 60, 70]])
    edges, fullness = read(mask((20, 40, 60, 50), (20, 55, 60, 70)), predicted)
    assert edges.tolist() == [[20, 40, 60, 70]]
    assert fullness == pytest.approx([25 / 30])


def test_a_thin_rim_is_cut_off():
    edges, _ = read(mask((20, 40, 60, 70), (60, 69, 90, 70)))
    assert edges.tolist() == [[20, 40, 60, 70]]


def test_a_line_of_one_row_or_column_is_no_error():
    lines = mask((10, 5, 150, 6), (3, 10, 4, 118))
    edges, _ = read(lines)
    assert len(edges) >= 2


def test_a_lorry_of_one_colour_does_not_melt_into_the_background():
    detector = MotionDetector()
    rng = np.random.default_rng(0)
    for index in range(120):
        image = GROUND + rng.integers(0, 5, GROUND.shape)
        left = max(140 - index, 0) if index >= 30 else 160
        image[40:90, left : left + 100] = 230
        found = detector.detect(image.astype(np.uint8))
    # 100 px at 1 px per frame: each place is hidden for longer than samples are remembered.
    assert found.boxes == pytest.approx(np.array([[21, 40, 100, 50]]), abs=4)


def test_what_a_parked_car_leaves_is_learnt():
    detector = MotionDetector()
    rng = np.random.default_rng(0)
    counts = []
    for index in range(330):
        image = GROUND + rng.integers(0, 5, GROUND.shape)
        if index < 60:
            image[60:84, 40:76] = PAINT
        counts.append(len(detector.detect(image.astype(np.uint8))))
    assert counts[61] == 1
    assert counts[-1] == 0


def seconds_until_learnt(rate):
    """Time in s after which what came into the scene, and stays, is background."""
    detector = MotionDetector()
    rng = np.random.default_rng(0)
    for index in range(30 + 20 * rate):
        image = GROUND + rng.integers(0, 5, GROUND.shape)
        if index >= 30:
            image[60:84, 40:76] = PAINT
        found = detector.detect(image.astype(np.uint8), (), 1 / rate)
        if index > 30 and not len(found):
            return (index - 30) / rate
    return np.inf


@pytest.mark.parametrize("rate", [5, 15, 60])
def test_what_stays_is_learnt_after_seconds_at_any_rate(rate):
    # Then some images more, until its colours are in two of ten samples.
    assert 4 < seconds_until_learnt(rate) < 4.2 + 30 / rate


@pytest.mark.parametrize(("rate", "images"), [(60, 19), (30, 19), (25, 19), (15, 10), (3, 10)])
def test_rare_images_are_all_taken_for_the_first_background(rate, images):
    detector = MotionDetector()
    blind = 0
    for _ in range(30):
        detector.detect(np.full((60, 80, 3), 100, np.uint8), period=1 / rate)
        blind += detector.is_blind
    assert blind == images


def test_blobs_that_hold_several_vehicles_are_reported():
    both = np.array([[20.0, 40, 40, 60], [42, 40, 62, 60]])
    reader, motion = BlobReader(), np.empty((0, 2))
    assert reader.read(mask((20, 40, 62, 60)), both, motion).ambiguous == 1
    assert reader.read(mask((20, 40, 40, 60), (42, 40, 62, 60)), both, motion).ambiguous == 0
    assert reader.read(mask((20, 20, 50, 44), (48, 43, 78, 67)), both[:0], motion).ambiguous == 1


def test_vehicles_of_a_blob_that_are_not_followed_are_estimated_by_its_size():
    reader = BlobReader()
    assert reader.read(mask((10, 10, 50, 50)), NOBODY, NOBODY[:, :2]).joined is None
    for left in range(20, 31):
        alone = np.array([[left, 40.0, left + 20, 60]])
        reader.read(mask((left, 40, left + 20, 60)), alone, NOBODY[:, :2])
    # Eight usual areas of 20 x 20 px are 7.2 vehicles, and one is followed.
    joined = reader.read(mask((30, 20, 110, 60)), alone, NOBODY[:, :2]).joined
    assert joined == pytest.approx(np.array([[30, 20, 110, 60, 6.2]]))
    assert not len(reader.read(mask((30, 40, 50, 60)), NOBODY, NOBODY[:, :2]).joined)


def test_a_change_of_gain_is_no_motion():
    detector = MotionDetector()
    for index, frame in enumerate(frames(60)):
        found = detector.detect(frame if index < 50 else (frame * 0.85).astype(np.uint8))
    assert not detector.disturbed
    assert len(found) == 1


def test_vehicles_whose_corners_touch_are_divided():
    both = mask((20, 20, 50, 44), (48, 43, 78, 67))
    edges, _ = read(both)
    assert len(edges) == 2
    assert edges[np.argsort(edges[:, 0])] == pytest.approx(
        np.array([[20, 20, 50, 44], [48, 43, 78, 67]]), abs=3
    )


def test_the_size_of_vehicles_tells_two_that_overlap_and_what_is_none():
    both, speck = mask((20, 20, 50, 50), (46, 35, 76, 65)), mask((20, 60, 28, 68))
    reader = BlobReader()
    assert [len(read(one, reader=reader)[0]) for one in (both, speck)] == [1, 1]
    for index in range(60):
        alone = np.array([[20 + index, 20 + index // 2, 50 + index, 50 + index // 2]])
        read(mask(*alone.tolist()), alone.astype(float), reader=reader)
    edges, _ = read(both, reader=reader)
    assert edges[np.argsort(edges[:, 0])] == pytest.approx(
        np.array([[20, 20, 50, 50], [46, 35, 76, 65]]), abs=5
    )
    assert len(read(speck, reader=reader)[0]) == 0


def test_pieces_that_look_like_vehicles_are_not_joined_by_one_prediction():
    both = mask((20, 20, 50, 44), (58, 50, 88, 74))
    edges, _ = read(both, [20.0, 20, 88, 74])
    assert len(edges) == 2


def test_a_speck_in_a_prediction_does_not_widen_the_box():
    edges, _ = read(mask((20, 40, 60, 70), (25, 22, 28, 25)), [20.0, 20, 60, 70])
    assert edges.tolist() == [[20, 40, 60, 70]]


def test_a_car_from_the_side_is_one_vehicle_as_soon_as_it_drives_across():
    aside = mask((20, 40, 45, 60), (45, 46, 70, 60))  # with a bonnet
    assert [len(read(aside, velocities=v)[0]) for v in ((), (0.0, 3.0), (3.0, 0.0))] == [2, 2, 1]
