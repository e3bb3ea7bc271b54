# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Changes of images and truth, to the pixel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stress_samples import COUNT, FPS, RED, WIDTH, box_of, red_share, write_sequence

from laboratory.stress import STRESS_KINDS, find_sequences, list_cases
from laboratory.stress.changes import Brightness, Gamma, Noise, Reduction, Shake
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth


def only(cases, kind):
    return next(case for case in cases if case.kind == kind)


def red_box(frame):
    """Bounds of the vehicle's pixels."""
    rows, columns = np.nonzero((frame == RED).all(axis=2))
    return Box(
        columns.min(), rows.min(), np.ptp(columns) + 1.0, np.ptp(rows) + 1.0
    )  # fmt: skip


def test_plain_is_the_sequence_itself(battery):
    played = list(only(battery, "plain").play())
    assert len(played) == COUNT
    assert all(frame.elapsed == 1.0 for frame in played)
    for index in (0, 60, COUNT - 1):
        assert played[index].truth.box == box_of(index) == red_box(played[index].frame)


def test_a_mirrored_vehicle_is_where_its_truth_says_to_the_pixel(battery):
    for index, played in enumerate(only(battery, "mirrored").play()):
        assert played.truth.box == red_box(played.frame)
        assert played.truth.box.x == WIDTH - box_of(index).x - box_of(index).width


def test_reversed_plays_backwards(battery):
    played = list(only(battery, "reversed").play())
    assert [frame.truth.box for frame in played] == [box_of(i) for i in range(COUNT)][::-1]
    assert red_box(played[0].frame) == box_of(COUNT - 1)
    stamps = [frame.truth.stamp_ns for frame in played]
    assert stamps == sorted(set(stamps))


def test_half_rate_takes_every_second_frame(battery):
    case = only(battery, "half_rate")
    played = list(case.play())
    assert case.fps == FPS / 2
    assert [frame.truth.box for frame in played] == [box_of(i) for i in range(0, COUNT, 2)]
    assert {frame.elapsed for frame in played} == {1.0}
    assert played[1].truth.stamp_ns - played[0].truth.stamp_ns == 2e9 / FPS


def test_dropped_frames_are_told_by_the_time_elapsed(battery):
    case = only(battery, "dropped_frames")
    places = np.cumsum([frame.elapsed for frame in case.play()]).astype(int) - 1
    boxes = [frame.truth.box for frame in case.play()]
    assert boxes == [box_of(int(i)) for i in places]
    assert 0.7 * COUNT < len(boxes) < 0.9 * COUNT
    assert boxes[0] == box_of(0)


def test_later_starts_are_in_full_view(tmp_path):
    write_sequence(tmp_path / "s", occlusion=lambda i: int(20 <= i < 50))
    cases = list_cases(find_sequences(tmp_path), kinds=["later_start"])
    assert 10 < len(cases) <= 20
    assert not any(20 <= case.first < 50 for case in cases)
    assert all(case.first + case.count == COUNT for case in cases)
    assert all(case.truths()[0].occlusion is Occlusion.NONE for case in cases)


def test_first_boxes_are_shifted_and_scaled_as_in_otb(battery):
    boxes = {case.variation: case.start_box() for case in battery if case.kind == "shifted_box"}
    assert len(boxes) == 12
    assert boxes["left"] == Box(6.0, 40.0, 20.0, 14.0)  # by 2 px, a tenth of 20
    assert boxes["down"].y == pytest.approx(41.4)
    assert boxes["right_up"].x == pytest.approx(10.0)
    assert boxes["scale_0.8"] == Box.around((18.0, 47.0), 16.0, 14.0 * 0.8)
    assert boxes["scale_1.2"].width == pytest.approx(24.0)


def test_brightness_and_gamma_follow_their_formula(drive):
    frame = np.arange(256, dtype=np.uint8).reshape(16, 16, 1).repeat(3, axis=2)
    bright = Brightness(1.4).painter(None, 0)(frame, 0)
    assert bright[0, 10, 0] == 14
    assert bright[-1, -1, 0] == 255
    dark = Gamma(2.0).painter(None, 0)(frame, 0)
    assert dark[8, 0, 0] == round(255 * (128 / 255) ** 2)
    assert frame[0, 10, 0] == 10  # untouched


def test_noise_has_its_deviation_and_leaves_grey_footage_grey():
    frame = np.full((80, 80, 3), 128, np.uint8)
    noisy = Noise(8.0).painter(None, 3)(frame, 7)
    assert np.std(noisy.astype(float)) == pytest.approx(8.0, rel=0.05)
    assert (noisy[..., 0] == noisy[..., 2]).all()
    again = Noise(8.0).painter(None, 3)(frame, 7)
    other = Noise(8.0).painter(None, 3)(frame, 8)
    assert (noisy == again).all()
    assert (noisy != other).any()


def truth(box):
    return Truth(0, box, Occlusion.NONE)


@settings(max_examples=40)
@given(index=st.integers(0, 2000), seed=st.integers(0, 2**32 - 1), amplitude=st.floats(0.1, 12))
def test_shake_moves_truth_and_image_alike(index, seed, amplitude):
    # On a ramp, linear interpolation is exact: its levels tell by how much the image moved.
    ramp = np.add.outer(np.arange(60), 2 * np.arange(60)).astype(np.uint8)[..., np.newaxis]
    frame = np.ascontiguousarray(ramp.repeat(3, axis=2))
    shake = Shake(amplitude)
    moved = shake.painter(None, seed)(frame, index)
    box = shake.truth(truth(Box(20.0, 20.0, 10.0, 10.0)), index, (60, 60), seed).box
    x, y = box.x - 20.0, box.y - 20.0
    assert max(abs(x), abs(y)) <= amplitude + 1e-9
    change = frame[25:35, 25:35, 0].astype(float) - moved[25:35, 25:35, 0]
    # Levels are rounded to one, and OpenCV's interpolation to a 32nd of a pixel along each axis.
    assert np.abs(change - (2 * x + y)).max() <= 0.5 + 3 / 32


def test_reduced_truth_is_where_the_reduced_vehicle_is():
    frame = np.zeros((90, 130, 3), np.uint8)
    frame[20:60, 40:80] = 255
    small = Reduction(0.5).painter(None, 0)(frame, 0)
    assert small.shape == (45, 65, 3)
    box = Reduction(0.5).truth(truth(Box(40, 20, 40, 40)), 0, (130, 90), 0).box
    assert box == Box(20, 10, 20, 20)
    assert (small[10:30, 20:40] == 255).all()
    assert small.astype(int).sum() == 3 * 255 * 20 * 20


def test_every_kind_is_described_and_plays(battery):
    for kind in STRESS_KINDS.values():
        cases = [case for case in battery if case.kind == kind.name]
        assert cases, kind.name
        frame, elapsed, first = next(cases[0].play())
        assert frame.dtype == np.uint8
        assert (elapsed, frame.ndim) == (1.0, 3)
        assert first.occlusion is Occlusion.NONE
        assert red_share(frame, first.box) > 0.5 or kind.group == "image"


def test_cameras_come_from_a_table(tmp_path):
    write_sequence(tmp_path / "a" / "one", count=25)
    write_sequence(tmp_path / "a" / "two", count=25)
    (tmp_path / "cameras.csv").write_text("sequence,camera\na/one,north\n")
    found = {source.name: source.camera for source in find_sequences(tmp_path)}
    assert found == {"a/one": "north", "a/two": "a/two"}
    table = tmp_path / "mine.csv"
    table.write_text("sequence,camera\na/one,x\na/two,x\n")
    assert {s.camera for s in find_sequences(tmp_path, table)} == {"x"}
    table.write_text("sequence,camera\na/one,x\na/one,y\n")
    with pytest.raises(InputError, match="twice"):
        find_sequences(tmp_path, table)


def test_a_folder_without_sequences_is_named(tmp_path):
    with pytest.raises(InputError, match=r"has no recording and no frame folder"):
        find_sequences(tmp_path)
    with pytest.raises(InputError, match="there is no sequence"):
        find_sequences(tmp_path / "nowhere")
