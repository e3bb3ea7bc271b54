# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Folders whose images are named by counts, words or times: order, stamps, refusals."""

import json
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.image_names import natural_key, number_images

START_NS = 1_000_000_000
EPOCH_NS = 1_403_636_579_763_555_584


@pytest.fixture
def folder(tmp_path):
    """Make a folder of images of these names, whose grey levels are their order."""

    def make(names, stated=None):
        for level, name in enumerate(names):
            cv2.imwrite(str(tmp_path / f"{name}.png"), np.full((4, 4, 3), level, np.uint8))
        if stated is not None:
            (tmp_path / "sequence.json").write_text(json.dumps({"fps": stated}))
        return tmp_path

    return make


def stamps_in_order(source):
    images = list(source.frames())
    assert [int(image.frame[0, 0, 0]) for image in images] == list(range(len(images)))
    return [image.stamp_ns for image in images]


def paths(names):
    return [Path("f", f"{name}.png") for name in names]


@pytest.mark.parametrize(
    "names",
    [
        [f"{n}_left" for n in range(1, 13)],
        [f"frame{n}" for n in range(8, 12)],
        [f"frame {n} (copy)" for n in range(8, 12)],
        [f"shot1.{n:04d}" for n in range(98, 103)],
        [f"v1.2.3-{n}" for n in range(9, 12)],
        [f"20130510{n:05d}" for n in range(9, 12)],
        [f"20130510_100000_{n:03d}" for n in range(9, 12)],
        [*"abcd"],
        ["a_640x480", "b_640x480", "c_640x480"],
    ],
)
def test_counts_and_words_are_in_natural_order_one_period_apart(folder, names):
    stamps = stamps_in_order(FrameFolder(folder(names), fps=10))
    assert stamps == [START_NS + index * 100_000_000 for index in range(len(names))]


SINCE_1970 = {
    "s with a fraction": ([f"1305031102.{n:06d}" for n in (783300, 816633, 850011)],
                          [1305031102_783300000, 1305031102_816633000, 1305031102_850011000]),
    "s": ([str(1305031102 + n) for n in range(3)], [(1305031102 + n) * 10**9 for n in range(3)]),
    "ms": ([str(EPOCH_NS // 10**6 + 50 * n) for n in range(3)],
           [EPOCH_NS // 10**6 * 10**6 + 50_000_000 * n for n in range(3)]),
    "us": ([str(EPOCH_NS // 10**3 + 50_000 * n) for n in range(3)],
           [EPOCH_NS // 10**3 * 10**3 + 50_000_000 * n for n in range(3)]),
    "ns": ([str(EPOCH_NS + 50_000_000 * n) for n in range(3)],
           [EPOCH_NS + 50_000_000 * n for n in range(3)]),
    "ns after words": ([f"left_{EPOCH_NS + 50_000_000 * n}" for n in range(3)],
                       [EPOCH_NS + 50_000_000 * n for n in range(3)]),
    "a count and ms": ([f"{n:02d}_{EPOCH_NS // 10**6 + 50 * n}" for n in range(3)],
                       [EPOCH_NS // 10**6 * 10**6 + 50_000_000 * n for n in range(3)]),
    "s and ns": (["1305031102_950000000", "1305031103_000000000", "1305031103_050000000"],
                 [1305031102_950000000, 1305031103_000000000, 1305031103_050000000]),
    "ns within a second": ([f"1305031102_{n:09d}" for n in (0, 50_000_000, 100_000_000)],
                           [1305031102_000000000, 1305031102_050000000, 1305031102_100000000]),
    "a fraction that is cut": (["1305031102.9", "1305031102.95", "1305031103"],
                               [1305031102_900000000, 1305031102_950000000, 1305031103_000000000]),
    "dates": (["2026-11-26_10-00-59", "2026-11-26_10-01-00", "2026-11-26_10-01-01"],
              [1795687259_000000000, 1795687260_000000000, 1795687261_000000000]),
    "dates with ms": ([f"20261126_100000_{n:03d}" for n in (0, 40, 80)],
                      [1795687200_000000000, 1795687200_040000000, 1795687200_080000000]),
}  # fmt: skip


@pytest.mark.parametrize("name", SINCE_1970)
def test_times_since_1970_are_the_stamps_to_the_nanosecond(folder, name):
    names, wanted = SINCE_1970[name]
    source = FrameFolder(folder(names))
    assert stamps_in_order(source) == wanted
    assert list(source.images) == [1, 2, 3]  # truth counts the images
    assert "from 1970 on; --fps takes their place" in source.notices[0]
    assert not any("states no frame rate" in notice for notice in source.notices)


@pytest.mark.parametrize(
    ("names", "wanted_ms"),
    [
        (["0.0333", "0.0667", "0.1000"], [0, 33.4, 66.7]),
        (["9.5", "10", "10.5"], [0, 500, 1000]),
        (["0", "33", "67", "100", "133"], [0, 33, 67, 100, 133]),
        (["500", "531", "566", "599", "634"], [0, 31, 66, 99, 134]),
        (["0", "33", "67", "200", "233"], [0, 33, 67, 200, 233]),
        (["0", "33333", "66667", "100000"], [0, 33.333, 66.667, 100]),
        (["7", "50000007", "100000007"], [0, 50, 100]),
        ([f"{n:019d}" for n in (0, 50_000_000, 100_000_000)], [0, 50, 100]),
    ],
)
def test_times_since_a_start_begin_at_the_first_image(folder, names, wanted_ms):
    stamps = stamps_in_order(FrameFolder(folder(names)))
    assert stamps == [START_NS + round(ms * 1e6) for ms in wanted_ms]


def test_the_rate_is_that_of_the_times(folder):
    names = [str(EPOCH_NS + 50_000_000 * n) for n in (0, 1, 2, 5, 6)]
    assert FrameFolder(folder(names)).fps == 20


@pytest.mark.parametrize("step", [2, 3, 5, 10])
def test_a_step_other_than_one_is_said_and_kept(folder, step):
    source = FrameFolder(folder([f"{step * n:06d}" for n in range(4)], stated=25))
    assert stamps_in_order(source) == [START_NS + step * n * 40_000_000 for n in range(4)]
    assert any(f"usually go up by {step}" in notice for notice in source.notices)


def test_a_gap_among_steps_of_one_is_not_said(folder):
    assert FrameFolder(folder(["5", "6", "7", "90"]), fps=10).notices == []


AMBIGUOUS = {
    "ms or every 40th": (["0", "40", "80", "120"], "milliseconds or of a count"),
    "s or ms": (["0", "1000", "2000"], "1000, fits no unit"),
    "fractions of ms": (["0.000", "33.333", "66.667"], "33.333 are not plausible as seconds"),
    "a version": (["cut_1.0001", "cut_1.0002"], "not plausible as seconds"),
    "labelled frames": (["1", "40", "150", "190", "390"], "milliseconds or of a count"),
    "two cameras": (["cam1_001", "cam1_002", "cam2_001"], "change, and not together"),
    "ns that lost zeros": (["1305031102_95", "1305031103_5", "1305031103_80"], "not together"),
    "a date and a count": (["20261126_100000_1", "20261126_100000_2", "20261126_100001_1"],
                           "not together"),
    "images and depth": (["f0001", "f0001_depth", "f0002", "f0002_depth"],
                         "different words have the same numbers"),
    "one time twice": (["1305031102", "1305031102.0"], "the same time"),
}  # fmt: skip


@pytest.mark.parametrize("name", AMBIGUOUS)
def test_ambiguous_names_are_one_sentence_that_names_fps(folder, name):
    names, why = AMBIGUOUS[name]
    with pytest.raises(InputError, match=f"{why}.*; give the frame rate with --fps$") as caught:
        FrameFolder(folder(names))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "names", [AMBIGUOUS["fractions of ms"][0], AMBIGUOUS["two cameras"][0], SINCE_1970["ns"][0],
              SINCE_1970["s with a fraction"][0], SINCE_1970["dates"][0], ["0", "33", "67"],
              ["0", "33333333", "66666667"]],
)  # fmt: skip
def test_a_rate_that_is_given_takes_the_place_of_all_times(folder, names):
    fps = 30 if names[-1] == "67" else 10
    stamps = stamps_in_order(FrameFolder(folder(names), fps=fps))
    assert stamps == [START_NS + round(index * 1e9 / fps) for index in range(3)]


def test_a_stated_rate_tells_milliseconds_from_a_count(folder):
    place = folder(["0", "40", "80", "120"], stated=25)
    assert stamps_in_order(FrameFolder(place)) == [START_NS + n * 40_000_000 for n in range(4)]
    (place / "sequence.json").write_text('{"fps": 10}')
    assert stamps_in_order(FrameFolder(place)) == [START_NS + n * 4_000_000_000 for n in range(4)]


def test_times_win_over_a_stated_rate(folder):
    source = FrameFolder(folder(SINCE_1970["ns"][0], stated=30))
    assert stamps_in_order(source) == SINCE_1970["ns"][1]


def test_images_beside_numbered_ones_are_said(folder):
    source = FrameFolder(folder(["1", "2", "background"]), fps=10)
    assert len(source.images) == 2
    assert "passed over: 1; " in source.notices[0]


def test_attributes_of_macos_are_no_images(folder):
    place = folder(["frame_0001", "frame_0002"])
    for number in (1, 2):
        (place / f"._frame_000{number}.png").write_bytes(b"\0\5\x16\7")
    (place / "._annotations.xml").write_bytes(b"\0\5\x16\7")
    source = FrameFolder(place, fps=10)
    assert len(stamps_in_order(source)) == 2
    assert source.notices == []


@given(
    first_ns=st.integers(1_000_000_000 * 10**9, 1_900_000_000 * 10**9),
    steps=st.lists(st.integers(1_000_000, 10**10), min_size=1, max_size=30),
    unit=st.sampled_from([1, 10**3, 10**6]),
    prefix=st.sampled_from(["", "frame_", "a "]),
)
def test_any_times_since_1970_are_read_back(first_ns, steps, unit, prefix):
    times = [first_ns // unit]
    for step in steps:
        times.append(times[-1] + step // unit)
    named = number_images(paths(f"{prefix}{time}" for time in times[::-1]))
    assert named.times_ns == [time * unit for time in times]
    assert [path.stem for path in named.images.values()] == [f"{prefix}{time}" for time in times]


@given(st.lists(st.integers(0, 10**6), min_size=1, unique=True), st.sampled_from(["", "a", "7b"]))
def test_counts_keep_their_order_and_numbers_at_a_known_rate(numbers, prefix):
    named = number_images(paths(f"x{prefix}{number}y" for number in numbers), 1e6, is_given=True)
    shown = [path.stem for path in named.images.values()]
    assert shown == [f"x{prefix}{number}y" for number in sorted(numbers)]


@given(st.lists(st.text("a1.0_", max_size=8)))
def test_the_natural_order_has_a_place_for_any_name(names):
    keys = [natural_key(name) for name in sorted(names, key=natural_key)]
    assert all(before <= after for before, after in pairwise(keys))
