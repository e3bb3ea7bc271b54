# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cost of fusion beside CSRT: turns, ratios and tables, with times given by hand."""

import numpy as np
import pytest

from benchmarks import fusion_cost
from benchmarks.fusion_cost import Costs, beside_csrt, by_image_size, csrt_table, size_table
from laboratory.stress.footage import StressFootage
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source

BOX = Box(10, 8, 12, 10)


def footage(frames, box=BOX):
    truth = tuple(None if box is None else Truth(index, box, 0) for index in range(frames))
    source = Source("camera/drive", "drive", "", frames, 48, 36, "0")
    return StressFootage(source, 30.0, truth, lambda index: np.full((36, 48, 3), index, np.uint8))


def stub(log, name, seconds):
    """A follower that tells who saw which frame, and in which box it began."""

    class Stub:
        def __init__(self, *_, **__):
            self.began = None

        def start(self, frame, box, seed):
            log.append((name, "start", frame.shape, box))

        def step(self, frame):
            log.append((name, int(frame[0, 0, 0])))
            return seconds

    return Stub


@pytest.fixture
def log(monkeypatch):
    seen = []
    monkeypatch.setattr(fusion_cost, "Own", stub(seen, "ours", 0.002))
    monkeypatch.setattr(fusion_cost, "Theirs", stub(seen, "csrt", 0.02))
    return seen


def test_both_see_every_frame_in_turns_of_ten(log):
    costs = beside_csrt(footage(24), None, None)
    assert costs.ms == {"fusion": [2.0] * 23, "csrt": [20.0] * 23}
    assert costs.size == "48x36"
    assert costs.ratios("fusion", "csrt") == pytest.approx((10.0, 10.0, 10.0))
    for name in ("ours", "csrt"):
        assert [entry[1] for entry in log if entry[0] == name] == ["start", *range(1, 24)]
    order = [entry[0] for entry in log[2:]]
    assert order == ["ours"] * 10 + ["csrt"] * 20 + ["ours"] * 10 + ["ours"] * 3 + ["csrt"] * 3


def test_the_number_of_frames_can_be_limited(log):
    assert len(beside_csrt(footage(24), None, 6).ms["fusion"]) == 5


def test_sizes_are_resampled_with_the_box(log):
    costs = by_image_size(footage(3))
    assert {name: len(times) for name, times in costs.ms.items()} == dict.fromkeys(
        ("VGA", "1080p", "4K"), 2
    )
    starts = [entry[2:] for entry in log if entry[1] == "start"]
    assert starts[2][0] == (2160, 3840, 3)
    assert starts[2][1] == Box(800, 480, 960, 600)


def test_a_first_frame_without_truth_is_refused(log):
    with pytest.raises(InputError, match="camera/drive has no truth"):
        beside_csrt(footage(3, None), None, None)


def test_tables_by_hand():
    beside = Costs("a/b", "48x36", {"fusion": [1.0, 2.0, 6.0], "csrt": [30.0, 20.0, 40.0]})
    assert csrt_table([beside]).splitlines()[-1] == (
        "| a/b | 48x36 | 3 | 3.00 | 2.00 | 1.00 | 6.0 | 30.0 | 30.0 | 20.0 | 10.0 | 15.0 | 20.0 |"
    )
    sizes = Costs("a/b", "", {"VGA": [2.0, 1.0, 3.0], "1080p": [2.2] * 3, "4K": [2.5] * 3})
    assert size_table([sizes]).splitlines()[-1] == (
        "| a/b | 2.00, 1.00 | 2.20, 2.20 | 2.50, 2.50 | 1.10, 2.20 | 1.25, 2.50 |"
    )
