# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The part of a hidden vehicle that is in view: by hand, and behind a drawn wall."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from fusion_samples import fusion
from street import HEIGHT, WIDTH, Street, follow

from vehicle_pf_tracker.image.motion.part_of_box import Part
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.fusion.part_in_view import part_in_view
from vehicle_pf_tracker.trackers.fusion.turning import Outlines
from vehicle_pf_tracker.trackers.fusion.verdict import Hidden, Visible

SIDES = np.array([[90.0, 50.0], [96.0, 66.0]])


def judged(share=0.3, bare=0.5, *, paint=0.5, another=False, verdict=None, nothing=False):
    """Probability for a vehicle in the box at 90 to 114, 50 to 66."""
    way = SimpleNamespace(is_another=lambda _: another)
    state = SimpleNamespace(
        verdict=Hidden(Outlines(reappearance=way)) if verdict is None else verdict,
        position=np.array([102.0, 58.0]),
        size=np.array([24.0, 16.0]),
    )
    part = None if nothing else Part(share, bare, SIDES)
    memory = SimpleNamespace(
        foreground=SimpleNamespace(part_in=lambda *_: part),
        appearance=SimpleNamespace(paint_share=lambda *_: paint),
    )
    return part_in_view(state, SimpleNamespace(memory=memory, frame=None))


def test_a_fifth_of_the_box_is_even_odds_and_a_tenth_more_seven_to_one():
    assert judged(0.2) == pytest.approx(0.5)
    assert judged(0.3) == pytest.approx(1 / (1 + math.exp(-2)))
    assert judged(0.1) == pytest.approx(1 / (1 + math.exp(2)))


@pytest.mark.parametrize(
    "why",
    [
        {"bare": 0.05},
        {"paint": 0.05},
        {"another": True},
        {"nothing": True},
        {"verdict": Visible()},
        {"verdict": Hidden()},
    ],
)
def test_no_part_is_in_view_of(why):
    assert judged(**why) == 0.0


class Walled(Street):
    """A red car with dark windows, and a wall wider than it at x 110 to 160."""

    def frame(self, time):
        frame = super().frame(10**6).copy()  # without the vehicle of four colours
        left = int(self.box(time).x)
        frame[50:66, left : left + 24] = (170, 40, 40)
        frame[53:57, left + 5 : left + 10] = frame[53:57, left + 13 : left + 18] = 30
        frame[:, 110:160] = np.arange(HEIGHT)[:, np.newaxis, np.newaxis] % 16 * 8 + 40
        return frame

    def visible(self, time):
        """Share of the vehicle's width beside the wall."""
        left = self.box(time).x
        return 1 - max(min(left + 24, 160) - max(left, 110), 0) / 24


@pytest.mark.parametrize("speed", [1.0, 2.0])
def test_a_vehicle_is_tracked_while_a_third_of_it_is_left_and_occluded_below_a_fifth(speed):
    """Without the part in view it is occluded up to .42 as it comes out, and from .33 before."""
    street = Walled(speed)
    times = range(round(140 / speed))
    estimates = follow(fusion(seed=0), street, times)
    assert street.box(times[-1]).x < WIDTH
    for time, estimate in zip(times, estimates, strict=True):
        share = street.visible(time)
        if not 0.2 < share < 0.32:
            assert estimate.mode is (Mode.TRACKING if share > 0.3 else Mode.OCCLUDED), time
