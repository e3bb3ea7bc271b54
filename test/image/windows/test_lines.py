# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Segments that were drawn, and lengths and directions by hand."""

from functools import partial

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.image.windows.lines import (
    direction_shares,
    find_lines,
    lengths_inside,
    line_histograms,
)
from vehicle_pf_tracker.image.windows.window import Bounds

found_in = partial(find_lines, edge_threshold=150.0, shortest=6)


def windows(*rectangles):
    return Bounds(*np.array(rectangles, dtype=np.intp).T)


def drawn(*segments, size=(60, 80)):
    frame = np.zeros((*size, 3), np.uint8)
    for start, end in segments:
        cv2.line(frame, start, end, (255, 255, 255), 1)
    return frame


def test_lengths_inside_by_hand():
    segments = np.array(
        [
            [0.0, 5.0, 10.0, 5.0],  # horizontal
            [4.0, 0.0, 4.0, 20.0],  # vertical
            [0.0, 0.0, 8.0, 8.0],  # diagonal
            [20.0, 20.0, 30.0, 20.0],  # elsewhere
        ]
    )
    inside = lengths_inside(segments, windows((2, 2, 6, 10), (0, 0, 40, 40)))
    assert inside[0] == pytest.approx([4.0, 8.0, 4 * np.sqrt(2), 0.0])
    assert inside[1] == pytest.approx([10.0, 20.0, 8 * np.sqrt(2), 10.0])


def test_directions_share_between_the_bins_beside_them():
    # Four bins of 45 degrees. 22.5 degrees is halfway; 157.5 lies between the last and the first.
    angle = np.deg2rad([0.0, 45.0, 90.0, 22.5, 157.5])
    segments = np.column_stack([np.zeros((5, 2)), np.cos(angle), np.sin(angle)])
    expected = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0.5, 0.5, 0, 0], [0.5, 0, 0, 0.5]]
    assert direction_shares(segments, 4) == pytest.approx(np.array(expected), abs=1e-9)


def test_a_direction_a_hair_below_the_horizontal_stays_in_the_bins():
    shares = direction_shares(np.array([[0.0, 0.0, 1.0, -1e-17]]), 8)
    assert shares.sum() == pytest.approx(1.0)
    assert shares[0, 0] == pytest.approx(1.0)


def test_line_histogram_by_hand():
    # 4 px of horizontal and 8 px of vertical line in the first window, none in the second.
    segments = np.array([[0.0, 5.0, 10.0, 5.0], [4.0, 0.0, 4.0, 20.0]])
    found = line_histograms(segments, windows((2, 2, 6, 10), (20, 20, 30, 30)), 4)
    assert found == pytest.approx(np.array([[1 / 3, 0, 2 / 3, 0], [0, 0, 0, 0]]))


def test_finds_a_drawn_rectangle():
    frame = drawn()
    frame[20:40, 10:50] = 200
    rectangle = windows((0, 0, 80, 60))
    found = line_histograms(found_in(frame, rectangle), rectangle, 4)[0]
    # 40 px against 20 px on each side: two thirds horizontal.
    assert found[0] == pytest.approx(2 / 3, abs=0.1)
    assert found[2] == pytest.approx(1 / 3, abs=0.1)


def test_a_blank_frame_has_no_lines():
    rectangle = windows((0, 0, 80, 60))
    segments = found_in(drawn(), rectangle)
    assert segments.shape == (0, 4)
    assert not line_histograms(segments, rectangle, 8).any()


def test_a_short_line_is_left_out():
    frame, rectangle = drawn(((20, 20), (31, 20))), windows((0, 0, 80, 60))
    assert len(found_in(frame, rectangle)) > 0
    assert len(found_in(frame, rectangle, shortest=20)) == 0


def test_segments_go_through_the_centres_of_pixels():
    frame = np.zeros((60, 80, 3), np.uint8)
    frame[:, 40:] = 255  # the gradient is largest in the columns 39 and 40
    segments = found_in(frame, windows((10, 10, 70, 50)))
    assert len(segments)
    assert np.all(segments % 1 == 0.5)
    assert set(segments[:, [0, 2]].ravel()) <= {39.5, 40.5}


def test_segments_are_in_the_frames_coordinates():
    frame = drawn()
    frame[30:, :] = 255  # an edge at y = 30
    whole = found_in(frame, windows((0, 0, 80, 60)))
    part = found_in(frame, windows((40, 20, 70, 40), (45, 25, 75, 45)))
    assert whole[:, [1, 3]] == pytest.approx(30, abs=1.0)
    assert part[:, [1, 3]] == pytest.approx(30, abs=1.0)
    assert part[:, [0, 2]].min() == pytest.approx(40, abs=4)
    assert part[:, [0, 2]].max() == pytest.approx(75, abs=4)
