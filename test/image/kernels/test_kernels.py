# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The kernels in numba against those in OpenCV and numpy."""

import numpy as np
import pytest
from feature_samples import grey
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.image.kernels import numba_edges
from vehicle_pf_tracker.image.kernels.interface import load_kernels
from vehicle_pf_tracker.image.windows.box_colours import COLOUR_BINS
from vehicle_pf_tracker.image.windows.colour import JointColour, RgbMarginals
from vehicle_pf_tracker.image.windows.gradients import GradientDirections, direction_bins
from vehicle_pf_tracker.image.windows.mean_shift import kernel_histogram
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.textures import BinaryPatterns, Cooccurrence
from vehicle_pf_tracker.image.windows.window import Window

OPENCV = load_kernels("opencv")
FEATURES = {
    "joint": JointColour(3),
    "joint, 1 bit": JointColour(1),
    "joint, 5 bits": JointColour(5),
    "marginals": RgbMarginals(),
    "directions": GradientDirections(),
    "directions, 80 %": GradientDirections(threshold=0.8, floor=40.0),
    "directions, 1 %": GradientDirections(threshold=0.01),
    "directions, unsigned": GradientDirections(signed=False),
    "directions, in window": GradientDirections(in_frame=False),
    "pairs": Cooccurrence(),
    "patterns": BinaryPatterns(),
}


@pytest.fixture(scope="module")
def numba():
    pytest.importorskip("numba", reason="numba is not installed")
    return load_kernels("numba")


def scene(seed, size, look):
    """Noise, smooth colours, or greys, down to a single colour."""
    rng = np.random.default_rng(seed)
    if look == "smooth":
        coarse = rng.integers(0, 256, (size[0] // 8 + 1, size[1] // 8 + 1, 3))
        return coarse.repeat(8, axis=0).repeat(8, axis=1)[: size[0], : size[1]].astype(np.uint8)
    if look == "grey":
        return grey(rng.integers(0, 256, size))
    levels = {"noise": 256, "two levels": 2, "one colour": 1}[look]
    values = rng.integers(0, levels, (*size, 3)) * (255 // max(levels - 1, 1))
    return values.astype(np.uint8)


scenes = st.builds(
    scene,
    st.integers(0, 2**32 - 1),
    st.tuples(st.integers(1, 40), st.integers(1, 60)),
    st.sampled_from(["noise", "smooth", "grey", "two levels", "one colour"]),
)
windows = st.builds(Window, st.integers(0, 14), st.integers(0, 9))


@st.composite
def clouds(draw, frame):
    """Positions close together or far apart, over the border, between pixels and on edges."""
    height, width = frame.shape[:2]
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count, spread = draw(st.sampled_from([1, 2, 9, 150])), draw(st.sampled_from([0.3, 4.0, 60.0]))
    middle = rng.uniform([-3, -3], [width + 3, height + 3])
    positions = middle + rng.normal(0, spread, (count, 2))
    return np.round(positions * 2) / 2 if draw(st.booleans()) else positions


@pytest.mark.parametrize("feature", FEATURES.values(), ids=list(FEATURES))
@settings(max_examples=60)
@given(data=st.data(), frame=scenes, window=windows)
def test_similarities_agree(numba, feature, data, frame, window):
    positions = data.draw(clouds(frame))
    histogram = feature.histograms(frame, data.draw(clouds(frame))[:1], window)[0]
    if data.draw(st.booleans()):
        histogram = histogram * (np.arange(feature.bins) % 3 > 0)
    reference = Reference(histogram)
    similarities = numba.similarity(feature, frame, positions, window, reference)
    expected = OPENCV.similarity(feature, frame, positions, window, reference)
    assert np.abs(similarities - expected).max() < 1e-6
    again = numba.similarity(feature, frame, positions, window, Reference(histogram))
    assert np.array_equal(similarities, again)


@pytest.mark.parametrize("feature", FEATURES.values(), ids=list(FEATURES))
@settings(max_examples=60)
@given(data=st.data(), frame=scenes, window=windows)
def test_histograms_are_the_same_to_the_last_bit(numba, feature, data, frame, window):
    position = data.draw(clouds(frame))[:1]
    expected = feature.histograms(frame, position, window)[0]
    for chosen in (numba, OPENCV):
        histogram = chosen.histogram(feature, frame, tuple(position[0].tolist()), window)
        assert histogram.tobytes() == expected.tobytes()


def test_edges_are_counted_alike_whatever_the_limits_of_the_other_windows(numba):
    # Faint noise beside a bright corner: limits differ by far more than one list of points has.
    frame = scene(7, (90, 160), "two levels") // 40 + 100
    frame[40:60, 70:90] = scene(8, (20, 20), "noise")
    feature, window = GradientDirections(threshold=0.3), Window(9, 7)
    positions = np.random.default_rng(9).uniform((0, 0), (160, 90), (300, 2))
    reference = Reference(feature.histograms(frame, np.array([[80.0, 50.0]]), window)[0])
    together = numba.similarity(feature, frame, positions, window, reference)
    apart = [
        numba.similarity(feature, frame, position[np.newaxis], window, reference)[0]
        for position in positions
    ]
    assert together.tolist() == apart
    expected = OPENCV.similarity(feature, frame, positions, window, reference)
    assert np.abs(together - expected).max() < 1e-6


@pytest.mark.parametrize("name", ["opencv", "numba"])
def test_nothing_is_like_an_empty_reference(request, name):
    chosen = OPENCV if name == "opencv" else request.getfixturevalue(name)
    frame, window = scene(1, (30, 40), "noise"), Window(4, 3)
    positions = np.random.default_rng(2).uniform(0, 30, (20, 2))
    for feature in FEATURES.values():
        reference = Reference(np.zeros(feature.bins))
        similarity = chosen.similarity(feature, frame, positions, window, reference)
        assert np.array_equal(similarity, np.zeros(20))


@settings(max_examples=80)
@given(data=st.data(), frame=scenes, window=windows, bits=st.sampled_from([1, 3, 5]))
def test_mean_shift_agrees(numba, data, frame, window, bits):
    positions = data.draw(clouds(frame))
    target = tuple(data.draw(clouds(frame))[0])
    reference = Reference(kernel_histogram(frame, target, window, bits))
    arguments = frame, positions, window, reference, bits
    similarities = numba.kernel_similarity(*arguments)
    assert np.abs(similarities - OPENCV.kernel_similarity(*arguments)).max() < 1e-9
    moved = numba.mean_shift(*arguments)
    assert np.abs(moved - OPENCV.mean_shift(*arguments)).max() < 1e-9
    assert np.array_equal(moved, numba.mean_shift(*arguments))


def test_mean_shift_stays_where_there_is_no_colour_of_the_reference(numba):
    frame = np.zeros((30, 30, 3), np.uint8)
    positions = np.array([[12.3, 9.7], [29.0, 29.0]])
    reference = Reference(np.eye(512)[511])
    moved = numba.mean_shift(frame, positions, Window(4, 4), reference, 3)
    assert np.array_equal(moved, positions)


@pytest.mark.parametrize("spread", [3.0, 500.0])
def test_strided_views_give_what_their_copies_give(numba, spread):
    whole = scene(3, (300, 400), "noise")
    positions = np.random.default_rng(4).normal((200, 150), spread, (40, 2))
    for frame in (whole[:, ::-1], whole[..., ::-1], whole[10:290, 20:390], whole[::-2]):
        frame.flags.writeable = False
        for feature in FEATURES.values():
            reference = Reference(feature.histograms(frame, positions[:1], Window(9, 7))[0])
            similarity = numba.similarity(feature, frame, positions, Window(9, 7), reference)
            copied = numba.similarity(feature, frame.copy(), positions, Window(9, 7), reference)
            assert np.array_equal(similarity, copied)


def test_a_window_larger_than_the_table_of_roots_is_compared_alike(numba):
    frame, window = scene(5, (400, 500), "smooth"), Window(240, 190)
    positions = np.random.default_rng(6).normal((250, 200), 5, (6, 2))
    reference = Reference(JointColour(3).histograms(frame, positions[:1], window)[0])
    similarity = numba.similarity(JointColour(3), frame, positions, window, reference)
    expected = OPENCV.similarity(JointColour(3), frame, positions, window, reference)
    assert np.abs(similarity - expected).max() < 1e-6


@pytest.mark.parametrize("signed", [True, False])
def test_directions_are_those_of_the_arc_tangent(signed):
    values = np.array([*range(-60, 61), -1020, -1019, -723, -511, 509, 721, 1019, 1020])
    gx, gy = (one.ravel() for one in np.meshgrid(values, values))
    gx, gy = gx[(gx != 0) | (gy != 0)], gy[(gx != 0) | (gy != 0)]
    found = [
        numba_edges.direction_bin.function(x, y, numba_edges.TANGENTS, signed)
        for x, y in zip(gx.tolist(), gy.tolist(), strict=True)
    ]
    assert found == direction_bins(gx, gy, signed=signed).tolist()


@pytest.mark.parametrize("name", ["opencv", "numba"])
def test_colours_of_boxes_are_counted_where_nothing_covers_them(request, name):
    chosen = OPENCV if name == "opencv" else request.getfixturevalue(name)
    frame = np.zeros((4, 6, 3), np.uint8)
    frame[:, 3:] = (255, 64, 128)  # levels 3, 1, 2: bin 3 * 16 + 1 * 4 + 2
    # Twelve pixels of each half; of the second box three are in the frame, and two shown.
    boxes = np.array([[0, 0, 6, 4], [-2, 3, 3, 9], [7, 0, 9, 4]])
    covers = np.array([[-5, 0, 2, 2], [1, 0, 4, 1], [1, 2, 2, 5]])
    counts = chosen.count_colours(frame, boxes, covers, np.array([2, 3, 3]))
    assert counts.shape == (3, COLOUR_BINS)
    assert counts[:, 0].tolist() == [12 - 4 - 1, 2, 0]
    assert counts[:, 54].tolist() == [12 - 1, 0, 0]
    assert counts.sum() == 20


@settings(max_examples=80)
@given(data=st.data(), frame=scenes, seed=st.integers(0, 2**32 - 1))
def test_colours_of_boxes_are_counted_alike(numba, data, frame, seed):
    rng = np.random.default_rng(seed)
    count = data.draw(st.integers(0, 5))
    ends = np.cumsum(rng.integers(0, 4, count), dtype=np.int64)
    boxes, covers = (rng.integers(-9, 70, (n, 4)) for n in (count, ends[-1] if count else 0))
    arguments = frame, boxes, covers, ends
    assert np.array_equal(numba.count_colours(*arguments), OPENCV.count_colours(*arguments))
