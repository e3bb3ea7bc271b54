# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sides of a drawn vehicle of 40 x 20 px, whose mask reaches half a pixel too far."""

import numpy as np
import pytest
from fusion_samples import contrasted, grey_road

from vehicle_pf_tracker.image.correlation.canonical_patch import cut_patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.foreground import Around
from vehicle_pf_tracker.trackers.fusion.sides import Sides, moved_box

NOISE = np.random.default_rng(3).integers(0, 256, (20, 40)).astype(np.uint8)
BODY = 255 - contrasted(NOISE, 1.5)
POSITION, SIZE = np.array([50.0, 40.0]), np.array([40.0, 20.0])


def around(left=0, right=0):
    """What moves around the box: the vehicle, whose sides are so many px beyond it."""
    mask = np.zeros((80, 100), np.uint8)
    mask[30:50, 30 - left : 70 + right] = 1
    return Around(mask, np.zeros(2), 1.0)


def looked(sides, left, seconds):
    """Look at it eight times a second."""
    for _ in range(int(8 * seconds)):
        sides = sides.looked(around(left), POSITION, SIZE).passed(0.125, SIZE)
    return sides


def edge_bias(sides):
    """What is believed of the left edge, beyond the vehicle's side."""
    return sides.means[0, 0, 1]


def test_one_look_counts_by_its_variances():
    """A second of drift has .002, the first box and the bias .0025 each, the edge .0196.

    The error is 8 - .5 px of 40.
    """
    sides = Sides().passed(0.6, SIZE).looked(around(8), POSITION, SIZE).passed(0.4, SIZE)
    assert sides.beyond[0, 0] == pytest.approx(0.1875 * 0.0045 / 0.0266)
    assert edge_bias(sides) == pytest.approx(0.1875 * 0.0025 / 0.0266)
    covariance = sides.covariances[0, 0]
    assert covariance[0, 1] == covariance[1, 0] == pytest.approx(-0.0045 * 0.0025 / 0.0266)
    # Of what the network sees nothing was told.
    assert covariance[2] == pytest.approx([0, 0, 0.0025])


def test_what_was_beyond_from_the_first_is_a_bias():
    """A shadow, or a loose first box; a side that moves away later is one of the vehicle."""
    shadow = looked(Sides(), 8, 4.0)
    assert edge_bias(shadow) > 0.05
    side = looked(looked(Sides(), 0, 2.0), 8, 4.0)
    assert side.beyond[0, 0] > 2 * edge_bias(side)
    # Most of the .2 that it has moved by.
    assert 0.1 < side.beyond[0, 0] < 0.2
    # The other sides are where they were, but for half a pixel.
    assert np.abs(side.beyond.ravel()[1:]).max() < 0.02


def test_an_edge_that_is_not_seen_changes_nothing():
    mask = around().mask.copy()
    mask[:, :30] = 1  # a neighbour at the left side
    sides = Sides().looked(Around(mask, np.zeros(2), 1.0), POSITION, SIZE).passed(1.0, SIZE)
    assert not sides.means[0, 0].any()
    assert sides.beyond[1, 0] < 0
    assert sides.looked(None, POSITION, SIZE).looks == ()


def test_the_background_is_looked_at_eight_times_a_second():
    sides = Sides().passed(0.1, SIZE)
    assert not sides.is_rested
    assert sides.passed(0.03, SIZE).is_rested
    # What is not seen costs as much as what is.
    assert not sides.passed(0.03, SIZE).looked(None, POSITION, SIZE).is_rested
    # After a doubt the vehicle may still be cut.
    assert not sides.passed(0.03, SIZE).doubted().is_rested


def test_a_doubt_discards_the_looks_just_before():
    cut = Sides().looked(around(-8), POSITION, SIZE).passed(0.2, SIZE)
    assert cut.beyond[0, 0] == 0
    assert cut.doubted().passed(1.0, SIZE).beyond[0, 0] == 0
    assert cut.passed(1.0, SIZE).beyond[0, 0] < 0


def test_the_box_has_its_own_distance_at_each_side():
    beyond = np.array([[0.1, 0.0], [-0.05, 0.2]])
    centre, size = moved_box(POSITION, SIZE, beyond)
    # From 30 - 4 to 70 - 2, and from 30 to 50 + 4.
    assert centre == pytest.approx([47, 42])
    assert size == pytest.approx([42, 24])


def network(left, share=1.0):
    """One that sees a vehicle with its left side so far beyond the middle of the box, px.

    Its answers follow a shift of the box by a share; it keeps the boxes.
    """
    boxes = []

    def look(centre, size):
        boxes.append((centre, size))
        off = share * (centre - POSITION) / size
        larger = share * (size - SIZE) / 2 / size
        first = np.array([left / size[0], 0.0])
        return np.array([first + off - larger, -off - larger])

    return look, boxes


def test_what_the_network_sees_counts_by_its_noise():
    """A half second of drift has .001, the box and the bias .0025 each, the network .01 here."""
    look, boxes = network(8)
    noise = np.array([[0.1, 0.2], [0.3, 0.4]])
    sides = Sides().passed(0.5, SIZE).seen(look, noise, POSITION, SIZE)
    assert sides.means[0, 0] == pytest.approx(0.2 * np.array([0.0035, 0, 0.0025]) / 0.016)
    assert sides.means.reshape(4, 3)[1:] == pytest.approx(0, abs=1e-12)
    assert sides.covariances[1, 1, 0, 0] == pytest.approx(0.0035 - 0.0035**2 / 0.166)
    centre, size = boxes[-1]
    assert np.array_equal(centre, POSITION)
    assert np.array_equal(size, SIZE)


def test_the_network_looks_halfway_to_the_reported_box():
    sides = looked(looked(Sides(), 0, 2.0), 8, 4.0)
    look, boxes = network(8)
    after = sides.seen(look, np.full((2, 2), 1e-6), POSITION, SIZE)
    low, high = sides.beyond[:, 0]
    assert boxes[-1][1][0] == pytest.approx(40 * (1 + (low + high) / 2))
    # Told without noise, both sum up to what was seen, wherever it was seen from.
    assert after.means[0, 0, [0, 2]].sum() == pytest.approx(0.2, abs=1e-6)


def test_it_is_measured_how_far_the_answers_follow_the_box():
    """Before and behind the box by .1 of it, in the first four looks."""
    look, boxes = network(8, share=0.25)
    sides = Sides()
    for _ in range(5):
        sides = sides.seen(look, np.ones((2, 2)), np.array([50.0, 40.0]), SIZE)
    assert sides.share == pytest.approx([0.25, 0.25])
    assert len(boxes) == 4 * 3 + 1
    first, second, third = (centre for centre, _ in boxes[:3])
    assert first == pytest.approx([54, 42])
    assert second == pytest.approx([46, 38])
    assert third == pytest.approx([50, 40])


def test_answers_that_follow_by_a_share_count_by_that_share():
    """Of a half the noise is twice as large: .0025 each, and .04 instead of .01."""
    look, _ = network(8, share=0.5)
    sides = Sides().seen(look, np.full((2, 2), 0.1), POSITION, SIZE)
    assert sides.means[0, 0] == pytest.approx(0.2 * np.array([0.0025, 0, 0.0025]) / 0.045)


@pytest.mark.parametrize("share", [0.0, -0.5])
def test_a_network_that_answers_the_same_wherever_it_looks_tells_nothing(share):
    look, _ = network(8, share)
    sides = Sides()
    for _ in range(20):
        sides = sides.passed(0.125, SIZE).seen(look, np.full((2, 2), 0.1), POSITION, SIZE)
    assert sides.means == pytest.approx(0, abs=1e-12)


def test_the_network_looks_eight_times_a_second():
    look, _ = network(0)
    sides = Sides().passed(0.1, SIZE)
    assert not sides.is_unseen
    assert sides.passed(0.03, SIZE).is_unseen
    assert not sides.passed(0.03, SIZE).seen(look, np.ones((2, 2)), POSITION, SIZE).is_unseen


def narrowed(widths):
    """Sides of a box that has had these widths, px, an eighth of a second apart."""
    sides = Sides()
    for width in widths:
        sides = sides.passed(0.125, np.array([width, 20.0]))
    return sides


def seen(sides, *looks):
    """Look at these masks, a tenth of a second apart."""
    for mask in looks:
        sides = sides.looked(mask, POSITION, SIZE).passed(0.1, SIZE)
    return sides


def test_a_flank_is_beyond_a_box_that_changes_its_shape():
    unfolded = seen(narrowed([47, 40]), around(8), around(9)).unfolded(SIZE)
    # Half a pixel less than the mask of the last look; above and below as believed.
    assert unfolded.beyond == pytest.approx(np.array([[8.5 / 40, 0], [-0.5 / 40, 0]]))
    # From 30 - 8.5 to 70 - .5.
    centre, size = unfolded.box(POSITION, SIZE)
    assert centre == pytest.approx([45.5, 40])
    assert size == pytest.approx([48, 20])


@pytest.mark.parametrize("widths", [[40, 40], [44, 40], [40]])
def test_beside_a_box_that_keeps_its_shape_is_a_shadow_or_a_neighbour(widths):
    """From 44 to 40 the shape changes by .095, of which .071 is not in its mean, less than .075."""
    assert seen(narrowed(widths), around(8), around(8)).unfolded(SIZE) is None


def test_a_flank_is_seen_in_all_looks_of_late():
    turns = narrowed([47, 40])
    assert turns.unfolded(SIZE) is None
    assert seen(turns, around(8)).unfolded(SIZE) is None
    # 4.5 px are .11 of the width.
    assert seen(turns, around(5), around(8)).unfolded(SIZE) is None
    assert seen(turns, around(8), around(5)).unfolded(SIZE) is None
    assert seen(turns, around(8), around(8)).doubted().unfolded(SIZE) is None


def test_a_vehicle_that_is_covered_at_its_other_end_shows_no_flank():
    """What is left of it seems to move: 8.5 px of 40 inside on the right, or 6.5."""
    turns = narrowed([47, 40])
    assert seen(turns, around(8, -8), around(8, -8)).unfolded(SIZE) is None
    assert seen(turns, around(8, -6), around(8, -6)).unfolded(SIZE) is not None


def test_a_mask_that_is_too_large_is_so_at_both_ends():
    turns = narrowed([47, 40])
    assert seen(turns, around(8, 1), around(8, 1)).unfolded(SIZE) is None
    mask = around(8).mask.copy()
    mask[:, 70:] = 1  # what is beside the other end hides its edge
    hidden = Around(mask, np.zeros(2), 1.0)
    assert seen(turns, hidden, hidden).unfolded(SIZE).beyond[:, 0] == pytest.approx([7.5 / 40, 0])


def driven(sides, frames, wide=30):
    """Follow a box on the middle of a vehicle of 40 px that drives by 6 px, ten frames a second.

    The vehicle is 5 px beyond either end of a box of 30 px, .17 of its width.
    """
    extent = 200, 100
    size = np.array([wide, 20.0])
    for time in range(frames):
        image = grey_road(200, 100)
        low = 10 + 6 * time
        image[40:60, low : low + 40] = BODY
        position = np.array([low + 20.0, 50.0])
        colours = np.repeat(image[..., None], 3, axis=2)
        sides = sides.passed(0.1, size)
        patch = cut_patch(colours, position, np.ones(2), 128)
        sides = sides.compared(patch, position, size, extent)
    return sides


def test_three_frames_show_the_edges_of_what_moves():
    assert driven(Sides(), 2).looks == ()
    three = driven(Sides(), 3)
    # Of the middle one, a tenth of a second ago.
    ((age, found),) = three.looks
    assert age == pytest.approx(0.1)
    assert found[:, 0] == pytest.approx([5 / 30, 5 / 30], abs=0.05)
    known = driven(Sides(), 12)
    assert 0.03 < known.beyond[:, 0].min() < known.beyond[:, 0].max() < 0.17


def test_looks_are_believed_in_the_order_of_their_frames():
    sides = driven(Sides(), 2).looked(around(), POSITION, SIZE)
    ages = [age for age, _ in driven(sides, 6).looks]
    assert ages == sorted(ages, reverse=True)


def test_a_doubt_and_a_moving_camera_end_a_comparison():
    two = driven(Sides(), 2)
    assert len(two.moments) == 2
    assert two.doubted().moments == two.parted().moments == ()
    assert two.moved(CameraMotion()) is two
    panned = two.moved(CameraMotion(shift=np.array([3.0, 0.0])))
    assert panned.moments[0].camera.shift == pytest.approx([3, 0])
