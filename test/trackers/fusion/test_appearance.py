# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The target's appearance: where the filter finds it, and what it learns."""

import numpy as np
import pytest
from fusion_samples import texture

from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.kernels.interface import load_kernels
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View
from vehicle_pf_tracker.trackers.fusion.parameters import FilterParameters

KERNELS = load_kernels("opencv")
SIZE = np.array([48.0, 30.0])
PLACE = np.array([160.0, 120.0])
PENALTY = FilterParameters().penalty


SMOOTH = {"blur": 2.0, "gain": 3.0}
ROAD = texture(1, **SMOOTH)
VEHICLE, OTHER = (texture(seed, 48, 30, **SMOOTH) for seed in (2, 3))


def frame(x=PLACE[0], y=PLACE[1], vehicle=VEHICLE):
    """The vehicle around a whole number of px."""
    picture = ROAD.copy()
    left, top = round(x - SIZE[0] / 2), round(y - SIZE[1] / 2)
    picture[top : top + 30, left : left + 48] = vehicle
    return picture


def learnt(*, penalty=0.1):
    appearance = Appearance(KERNELS, SIZE, SIZE, penalty)
    appearance.learn_first(frame(), PLACE, SIZE)
    return appearance


def usual():
    """An appearance that has seen its vehicle once, so that responses are relative to that."""
    appearance = learnt()
    view_at(appearance, frame(), PLACE)
    return appearance


def view_at(appearance, picture, position, size=SIZE, *, wide=False):
    patch = appearance.patch(picture, np.array(position, float), size, wide=wide)
    if not appearance.has_level:
        appearance.learn_level(patch)
    return appearance.view(patch)


def test_the_target_has_its_canonical_size_in_the_patch():
    patch = learnt().patch(frame(), PLACE, SIZE)
    assert patch.side == 128
    assert np.sqrt((SIZE * patch.zoom).prod()) == pytest.approx(40)
    assert (SIZE * patch.zoom)[0] / (SIZE * patch.zoom)[1] == pytest.approx(48 / 30)
    twice = learnt().patch(frame(), PLACE, 2 * SIZE)
    assert twice.zoom == pytest.approx(patch.zoom / 2)


@pytest.mark.parametrize("size", [(1.0, 1.0), (3.0, 2.0), (4.0, 300.0), (900.0, 600.0)])
def test_any_size_leaves_background_in_the_patch(size):
    size = np.array(size)
    patch = Appearance(KERNELS, size, size, PENALTY).patch(frame(), PLACE, size)
    assert (size * patch.zoom).max() <= 0.6 * patch.side + 1e-9
    assert patch.zoom.max() <= 8


def test_the_first_patch_sets_what_is_usual():
    appearance = learnt()
    assert view_at(appearance, frame(), PLACE).response.max() == pytest.approx(1)
    assert appearance.usual_response > 0
    appearance.learn_usual(1.5, 0.1)
    assert view_at(appearance, frame(), PLACE).response.max() == pytest.approx(1 / 1.05, rel=1e-4)


@pytest.mark.parametrize("offset", [(0, 0), (5, -3), (-12, 4), (15, 10)])
def test_the_peak_is_where_the_target_is(offset):
    appearance = learnt()
    view = view_at(appearance, frame(), PLACE - offset)
    found, height = view.peak_near(PLACE, 6)
    assert found == pytest.approx(PLACE, abs=0.8)
    assert height > 0.5
    rows, columns = np.unravel_index(view.response.argmax(), view.response.shape)
    assert view.places(PLACE) == pytest.approx([columns, rows], abs=1)


def test_a_large_box_is_found_in_a_wide_patch_only():
    appearance = usual()
    away = PLACE + np.array([70, 45])
    wide = view_at(appearance, frame(*away), PLACE, wide=True)
    assert wide.spectrum is None
    assert wide.patch.side == 256
    rows, columns = np.unravel_index(wide.response.argmax(), wide.response.shape)
    assert wide.places(away) == pytest.approx([columns, rows], abs=1)
    inner = appearance.usual_patch(wide.patch)
    assert inner.side == 128
    assert appearance.usual_patch(inner) is inner


def test_another_vehicle_answers_less():
    assert view_at(usual(), frame(vehicle=OTHER), PLACE).response.max() < 0.5


def test_a_wrong_size_answers_less():
    appearance = usual()
    sizes = [factor * SIZE for factor in (0.85, 0.93, 1.0, 1.08, 1.18)]
    answers = appearance.responses_at(frame(), PLACE, sizes)
    assert np.argmax(answers) == 2
    assert answers == sorted(answers[:3]) + sorted(answers[3:], reverse=True)


def test_a_first_view_without_the_target_is_not_usual():
    appearance = learnt()
    hidden = view_at(appearance, ROAD, PLACE)
    assert hidden.response.max() < 0.8
    assert view_at(appearance, frame(), PLACE).response.max() > 1


def test_the_response_at_a_box_is_that_of_the_whole_view_there():
    appearance = learnt()
    view = view_at(appearance, frame(), PLACE)
    (response,) = appearance.responses_at(frame(), PLACE, [SIZE])
    assert response == pytest.approx(view.at(PLACE), abs=0.02)


@pytest.mark.parametrize("kernels", ["opencv", "auto"])
def test_several_sizes_have_the_bits_that_each_has_alone(kernels):
    appearance = usual()
    appearance.use_kernels(load_kernels(kernels))
    sizes = [SIZE, SIZE / 1.03, 1.9 * SIZE]
    together = appearance.responses_at(frame(), PLACE, sizes)
    assert together == [appearance.responses_at(frame(), PLACE, [size])[0] for size in sizes]


@pytest.mark.parametrize("away", [2.0, 14.0], ids=["shifted cells", "measured again"])
def test_learning_adapts_the_filter_to_a_new_look(away):
    appearance = usual()
    mixed = (0.5 * VEHICLE + 0.5 * OTHER).astype(np.uint8)
    picture = frame(vehicle=mixed)
    before = view_at(appearance, picture, PLACE).response.max()
    for _ in range(5):
        view = view_at(appearance, picture, PLACE - [away, 0])
        appearance.learn(picture, view, PLACE, SIZE, 0.5)
    view = view_at(appearance, picture, PLACE)
    assert view.response.max() > before + 0.1
    assert view.peak_near(PLACE, 6)[0] == pytest.approx(PLACE, abs=1)


def parabola(top, width=40):
    """A view of 1 px per place whose response is a parabola with its vertex at `top`."""
    y, x = np.mgrid[:width, :width].astype(float)
    response = (1 - 0.001 * ((x - top[0]) ** 2 + (y - top[1]) ** 2)).astype(np.float32)
    grey = np.zeros((2 * width, 2 * width), np.uint8)
    patch = Patch(
        np.zeros((2 * width, 2 * width, 3), np.uint8), grey, np.full(2, 100.0), np.full(2, 2.0)
    )
    return View(patch, None, response)


def test_the_vertex_of_a_parabola_is_found_exactly():
    """The middle, place 20, is at 100 px; places are 2 canonical px, here 1 px, apart."""
    view = parabola((23.3, 17.6))
    assert view.steps == pytest.approx([1, 1])
    position, height = view.peak_near(np.array([102.0, 99.0]), 6)
    assert position == pytest.approx([103.3, 97.6], abs=0.01)
    assert height == pytest.approx(1 - 0.001 * (0.3**2 + 0.4**2))


def test_the_peak_is_sought_within_reach_only_and_inside_the_patch():
    view = parabola((30.0, 20.0))
    position, _ = view.peak_near(np.array([100.0, 100.0]), 3)
    assert position[0] == pytest.approx(103.5)
    for far in (-1e4, 1e4):
        position, height = view.peak_near(np.array([far, far]), 6)
        assert np.isfinite(position).all()
        assert np.isfinite(height)
        assert (view.places(np.array([[far, far]])) == (0 if far < 0 else 39)).all()


@pytest.mark.parametrize("level", [0, 119, 255])
def test_an_image_without_any_contrast_gives_finite_responses(level):
    blank = np.full((120, 160, 3), level, np.uint8)
    appearance = Appearance(KERNELS, SIZE, SIZE, PENALTY)
    appearance.learn_first(blank, np.array([80.0, 60.0]), SIZE)
    view = view_at(appearance, blank, (80, 60))
    assert np.isfinite(view.response).all()
    assert np.isfinite(appearance.responses_at(blank, np.array([80.0, 60.0]), [SIZE]))
    appearance.learn(blank, view, np.array([80.0, 60.0]), SIZE, 5.0)
    assert np.isfinite(view_at(appearance, blank, (80, 60)).response).all()


def plain(*stripes):
    """A frame of one grey, with stripes of x, width and colour at the height of the vehicle."""
    picture = np.full((240, 320, 3), 90, np.uint8)
    for left, width, colour in stripes:
        picture[105:135, left : left + width] = colour
    return picture


YELLOW, DULLER, GREY = (200, 180, 40), (176, 158, 35), (140, 140, 140)


@pytest.mark.parametrize(
    ("stripes", "share"),
    [
        ([(136, 48, YELLOW)], 1.0),
        ([(136, 48, GREY)], 0.0),
        ([(136, 24, YELLOW), (160, 24, GREY)], 0.5),
        ([(136, 12, DULLER), (148, 36, GREY)], 0.25),
    ],
    ids=["the same", "another", "half of it", "a quarter in weaker light"],
)
def test_paint_is_told_by_the_share_of_a_box_that_has_it(stripes, share):
    appearance = Appearance(KERNELS, SIZE, SIZE, PENALTY)
    appearance.learn_paint(plain((136, 48, YELLOW)), PLACE, SIZE)
    found = appearance.paint_share(plain(*stripes), PLACE, SIZE)
    assert found == pytest.approx(share, abs=0.13)
