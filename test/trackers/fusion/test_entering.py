# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle that drives into the image behind a first box which the border cuts."""

import numpy as np
import pytest
from fusion_samples import contrasted, fusion, grey_road

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.parameters.table import from_mapping, to_mapping
from vehicle_pf_tracker.trackers.fusion.entering import Entry
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters

WIDTH, HEIGHT = 200, 90
TOP, TALL = 30, 24
FIRST = 20
"""Width of the part that is in view in the first image, px."""
SPEED = 3
ROAD = grey_road(WIDTH, HEIGHT)
BODY = 255 - contrasted(np.random.default_rng(2).integers(0, 256, (TALL, 60)).astype(np.uint8), 1.5)


def picture(time, length, pan=0):
    """Road with the first `length` px of a body whose front is at `FIRST` + `SPEED` * `time`.

    A camera that has panned by `pan` px sees both farther to the left.
    """
    image = np.roll(ROAD, -pan, axis=1)
    front = FIRST + SPEED * time
    tail = max(front - length, 0)
    image[TOP : TOP + TALL, tail:front] = BODY[:, : front - tail][:, ::-1]
    return image


def coloured(grey):
    """A frame of these grey levels."""
    return np.repeat(grey[..., None], 3, axis=2)


def entered(length, frames, pans=0):
    """Follow the first 20 px of a vehicle of this length; give what is known after some frames.

    The box is that of the 20 px at the front. The background moves by `pans` px to the left each
    frame.
    """
    size = np.array([FIRST, TALL], float)
    entry = Entry.of_box(np.array([FIRST / 2, TOP + TALL / 2]), size, np.array([WIDTH, HEIGHT]))
    for time in range(frames):
        position = np.array([FIRST / 2 + SPEED * time, TOP + TALL / 2])
        entry = entry.moved(
            CameraMotion(shift=np.array([-float(pans), 0.0])) if pans else CameraMotion()
        )
        entry = entry.looked(coloured(picture(time, length, pans * time)), position, size)
    return entry, position, size


@pytest.mark.parametrize(
    ("x", "y", "cut"),
    [
        (10, 40, [[True, False], [False, False]]),
        (190, 40, [[False, False], [True, False]]),
        (100, 12, [[False, True], [False, False]]),
        (188, 77, [[False, False], [True, True]]),
    ],
)
def test_sides_near_the_border_may_be_cut(x, y, cut):
    # A tenth of the longer side, 2.4 px: a side at 2 px counts, one at 3 does not.
    entry = Entry.of_box(np.array([x, y], float), np.array([20.0, 24.0]), np.array([200.0, 90.0]))
    assert entry.is_cut.tolist() == cut


def test_a_box_away_from_the_border_is_whole():
    size = np.array([20.0, 24.0])
    assert Entry.of_box(np.array([13.0, 45.0]), size, np.array([200.0, 90.0])) is None


@pytest.mark.parametrize("pans", [0, 2])
@pytest.mark.parametrize("length", [30, 40, 50])
def test_a_vehicle_is_as_long_as_what_moves_with_it(length, pans):
    entry, position, size = entered(length, 40, pans)
    centre, whole = entry.grown(position, size)
    # A shadow of .15 of the box, 3 px, is taken off; a cell has 1.25 px.
    assert whole == pytest.approx([length - 3, TALL], abs=2)
    assert centre[0] + whole[0] / 2 == pytest.approx(position[0] + size[0] / 2)
    assert entry.remaining(size) is None


def followed(frames):
    """Follow the first 20 px of what drives through these frames; give what is known at last."""
    size = np.array([FIRST, TALL], float)
    entry = Entry.of_box(np.array([FIRST / 2, TOP + TALL / 2]), size, np.array([WIDTH, HEIGHT]))
    for time, frame in enumerate(frames):
        position = np.array([FIRST / 2 + SPEED * time, TOP + TALL / 2])
        entry = entry.looked(frame, position, size)
    return entry, position, size


def test_a_vehicle_as_bright_as_the_road_is_seen_by_its_colour():
    """Red of a luminance of 100, as the road has: what it has of red it lacks of green."""
    red = BODY.astype(float) / 4 + 30
    body = np.dstack((100 + red, 100 - red * (0.299 / 0.587), np.full_like(red, 100)))

    def frame(time):
        image = coloured(np.full((HEIGHT, WIDTH), 100, np.uint8))
        front = FIRST + SPEED * time
        tail = max(front - 40, 0)
        image[TOP : TOP + TALL, tail:front] = body[:, : front - tail][:, ::-1].round()
        return image

    entry, position, size = followed(frame(time) for time in range(40))
    assert entry.grown(position, size)[1] == pytest.approx([40 - 3, TALL], abs=2)


def test_a_plain_bonnet_is_followed_by_a_cabin():
    """The half of the box that is nearer to the border is as grey as the road."""

    def frame(time):
        image = picture(time, 40)
        front = FIRST + SPEED * time
        plain = slice(max(front - FIRST, 0), front - FIRST // 2)
        image[TOP : TOP + TALL, plain] = 100
        return coloured(image)

    entry, position, size = followed(frame(time) for time in range(40))
    assert entry.grown(position, size)[1] == pytest.approx([40 - 3, TALL], abs=2)


@pytest.mark.parametrize("wide", [10, 16])
def test_what_stands_in_front_of_it_is_not_the_road_behind_it(wide):
    """Stripes at the border, as of a clock: the vehicle comes in behind them."""
    stripes = np.where(np.arange(wide) % 4 < 2, 0, 255)

    def frame(time):
        image = picture(time, 40)
        image[:, :wide] = stripes
        return coloured(image)

    entry, position, size = followed(frame(time) for time in range(18))
    # The tail is at 31 px, past the stripes.
    assert entry.grown(position, size)[1] == pytest.approx([40 - 3, TALL], abs=3)


def test_what_is_whole_is_left_as_it_is():
    entry, position, size = entered(FIRST, 40)
    assert entry.grown(position, size) is None
    assert entry.remaining(size) is None


def test_a_vehicle_behind_it_is_another():
    """A gap of 10 px is more than four tenths of the longer side, 24 px."""
    size = np.array([FIRST, TALL], float)
    entry = Entry.of_box(np.array([FIRST / 2, TOP + TALL / 2]), size, np.array([WIDTH, HEIGHT]))
    for time in range(40):
        image = picture(time, 30)
        tail = FIRST + SPEED * time - 40
        if tail > 0:
            image[TOP : TOP + TALL, max(tail - 30, 0) : tail] = BODY[:, : min(tail, 30)][:, ::-1]
        position = np.array([FIRST / 2 + SPEED * time, TOP + TALL / 2])
        entry = entry.looked(coloured(image), position, size)
    assert entry.grown(position, size)[1][0] == pytest.approx(27, abs=2)


def test_the_reported_box_reaches_to_the_border_while_more_comes_in():
    entry, position, size = entered(60, 8)
    # The front is at 41 px: all of it is vehicle.
    centre, seen = entry.box(position, size)
    assert centre[0] - seen[0] / 2 == pytest.approx(0, abs=0.5)
    assert seen[0] == pytest.approx(41, abs=0.5)
    assert entry.remaining(size) is not None


def test_a_vehicle_that_waits_is_not_looked_at():
    size = np.array([FIRST, TALL], float)
    position = np.array([FIRST / 2, TOP + TALL / 2])
    entry = Entry.of_box(position, size, np.array([WIDTH, HEIGHT]))
    for _ in range(10):
        entry = entry.looked(coloured(picture(0, 60)), position, size)
    assert len(entry.moments) == 1
    assert entry.box(position, size)[1] == pytest.approx(size)


def test_images_before_a_doubt_are_not_compared_with_those_after_it():
    entry, position, size = entered(40, 20)
    lost = entry.lost()
    assert lost.moments == ()
    assert lost.box(position, size)[1] == pytest.approx(entry.box(position, size)[1])


def driven_in(seed):
    """A tracker that has followed a vehicle of 50 px from its first 20 px on."""
    tracker = fusion(seed=seed)
    frames = (coloured(picture(time, 50)) for time in range(45))
    tracker.start(next(frames), Box(0, TOP, FIRST, TALL))
    for frame in frames:
        estimate = tracker.step(frame)
    return tracker, estimate


@pytest.mark.parametrize("seed", range(3))
def test_fusion_follows_the_whole_vehicle(seed):
    tracker, estimate = driven_in(seed)
    # What was taken off for a shadow comes back, as the edges are beyond the box.
    assert estimate.box.width == pytest.approx(48, abs=3.5)
    assert tracker.state.whole.entry is None


def test_a_filter_that_new_parameters_learn_anew_knows_the_whole_vehicle():
    tracker, before = driven_in(0)
    doubled = {"filter.penalty": 2 * tracker.parameters.filter.penalty}
    tracker.reconfigure(
        from_mapping(FusionParameters, {**to_mapping(tracker.parameters), **doubled})
    )
    for time in range(45, 50):
        estimate = tracker.step(coloured(picture(time, 50)))
    moved = 5 * SPEED
    assert estimate.position[0] - before.position[0] == pytest.approx(moved, abs=2)
    assert estimate.box.width == pytest.approx(before.box.width, abs=4)
