# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The README's animation: both trackers in each picture, and a file that a page can carry."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tools import animation
from vehicle_pf_tracker.scenes.catalogue import make_scene

SHIPPED = Path(__file__).parents[2] / "docs" / "images" / "occlusions.webp"
MOST_BYTES = 3_000_000


@pytest.fixture(scope="module")
def shown():
    frames = [frame for frame, _ in zip(make_scene("highway").frames(), range(3), strict=False)]
    return frames, list(animation.pictures(frames))


def test_each_picture_has_the_road_twice(shown):
    frames, pictures = shown
    road = frames[2].frame[animation.ROWS]
    for part in (pictures[2][: len(road)], pictures[2][-len(road) :]):
        untouched = (part == road).all(axis=2)
        assert 0.9 < untouched.mean() < 1.0  # box, path and words are drawn over it
    assert len(pictures) == 3


def test_the_two_differ_where_they_track_differently(shown):
    _, pictures = shown
    height = animation.ROWS.stop - animation.ROWS.start
    assert (pictures[2][:height] != pictures[2][-height:]).any()


def test_the_file_repeats_and_holds_its_last_picture(shown, tmp_path):
    path = tmp_path / "short.webp"
    animation.write_animation(path, shown[1], 100.0)
    with Image.open(path) as image:
        assert (image.n_frames, image.info["loop"]) == (3, 0)
        first = np.asarray(image.convert("RGB")).astype(int)
        image.seek(2)
        image.load()
        assert image.info["duration"] == animation.HOLD_MS
    assert np.abs(first - shown[1][0]).mean() < 8  # the same picture but for lossy coding


def test_the_shipped_file_is_such_an_animation_and_small():
    assert SHIPPED.stat().st_size < MOST_BYTES
    with Image.open(SHIPPED) as image:
        scene = make_scene(animation.SCENE)
        height = animation.ROWS.stop - animation.ROWS.start
        assert image.size == (scene.width, 2 * height + animation.GAP_PX)
        assert image.n_frames == len(range(0, scene.frame_count, animation.EVERY))
