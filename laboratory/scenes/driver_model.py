# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drivers who follow each other, change lanes and wait at red lights (intelligent driver model)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

_ACCELERATION, _BRAKING = 1.5, 2.0
"""Comfortable acceleration and braking, m/s²: Treiber's intelligent driver model in towns."""
_HARDEST = 8.0
"""Hardest braking that tyres allow, m/s²: a friction of 0.8, as on dry asphalt."""
_GAP, _HEADWAY = 2.0, 1.2
"""Gap to a vehicle that stands, m, and time to one that drives, s, of the same model."""
_IMPATIENT = 0.85
"""Share of the wanted speed below which the vehicle ahead is overtaken."""
_LOOK_AHEAD = 30.0
"""Distance in which a slower vehicle ahead makes a driver change lanes, m."""
_ROOM_AHEAD, _ROOM_BEHIND = 14.0, 12.0
"""Room needed in the other lane, m: about three lengths of a car each way, a choice."""
_CHANGE = 2.5
"""Duration of a change of lanes, s: brisk, so that many changes are seen as a whole. A choice."""
_PATIENCE = 3.0
"""Shortest time between two changes of one driver, s."""


class Driver(NamedTuple):
    """A driver in traffic.

    Attributes
    ----------
    lane : int
        Lane in the beginning.
    front : float
        Position of the front along the road in the beginning, m.
    length : float
        Length of the vehicle, m.
    speed : float
        Wanted speed, m/s.
    """

    lane: int
    front: float
    length: float
    speed: float


class Hold(NamedTuple):
    """A red light at `place` (m along the road), from `begin` to `end` (s)."""

    place: float
    begin: float
    end: float


class Flow(NamedTuple):
    """Way of every driver.

    Attributes
    ----------
    front : array, shape (drivers, frames)
        Position of the front along the road, m.
    lane : array, shape (drivers, frames)
        Lane, with fractions during changes.
    """

    front: Array
    lane: Array


class _Traffic:
    """State of all drivers while they are simulated."""

    def __init__(self, drivers: Sequence[Driver], lanes: int, period: float) -> None:
        self.lanes = lanes
        self.period = period
        lanes_of, self.front, self.length, self.wanted = np.transpose(np.array(drivers))
        self.speed = self.wanted.copy()
        self.origin = lanes_of.astype(np.int64)
        self.goal = self.origin.copy()
        self.since = np.full(len(drivers), -math.inf)
        self.time = 0.0

    @property
    def progress(self) -> Array:
        """Share of the present change of lanes that is done, smooth at both ends."""
        # 3 s² - 2 s³, whose slope is 0 at both ends: nobody jerks the wheel.
        share = np.clip((self.time - self.since) / _CHANGE, 0.0, 1.0)
        smooth: Array = share * share * (3 - 2 * share)
        return smooth

    @property
    def lane(self) -> Array:
        """Lane with fractions."""
        lane: Array = self.origin + (self.goal - self.origin) * self.progress
        return lane

    def occupies(self) -> npt.NDArray[np.bool_]:
        """Lanes that each driver occupies, shape (drivers, lanes): two during a change."""
        numbers = np.arange(self.lanes)
        done = self.progress >= 1
        here = numbers == self.goal[:, None]
        return np.asarray(here | ((numbers == self.origin[:, None]) & ~done[:, None]))

    def step(self, holds: Sequence[Hold]) -> None:
        """Advance by one frame."""
        # Intelligent driver model (Treiber, Hennecke and Helbing 2000): the wanted gap has a fixed
        # part, one for the reaction time, and one for the speed of closing in; its exponent is 4.
        gap, closing = self._ahead(holds)
        approach = self.speed * closing / (2 * math.sqrt(_ACCELERATION * _BRAKING))
        wanted_gap = _GAP + np.maximum(0.0, self.speed * _HEADWAY + approach)
        thrust = _ACCELERATION * (
            # At least 0.1 m in the denominator: a gap of 0 would be an infinite thrust.
            1 - (self.speed / self.wanted) ** 4 - (wanted_gap / np.maximum(gap, 0.1)) ** 2
        )
        thrust = np.maximum(thrust, -_HARDEST)
        before = self.speed
        self.speed = np.maximum(before + thrust * self.period, 0.0)
        # Never into the vehicle ahead, however the scene begins.
        self.front += np.minimum((before + self.speed) / 2 * self.period, np.maximum(gap - 0.3, 0))
        self.time += self.period

    def change_lanes(self) -> None:
        """Let impatient drivers begin to change, the first ones first."""
        gap, _ = self._ahead(())
        # Not below 2 m/s: in a queue the other lane is no faster.
        slow = (self.speed < _IMPATIENT * self.wanted) & (gap < _LOOK_AHEAD) & (self.speed > 2)
        # A change that is under way comes to its end before the next is thought of.
        rested = self.time - self.since > _CHANGE + _PATIENCE
        for index in np.flatnonzero(slow & rested)[np.argsort(-self.front[slow & rested])]:
            # The higher lane first; the order only matters where both have room.
            for lane in (self.goal[index] + 1, self.goal[index] - 1):
                if 0 <= lane < self.lanes and self._has_room(int(index), int(lane)):
                    self.origin[index], self.goal[index] = self.goal[index], lane
                    self.since[index] = self.time
                    break

    def _ahead(self, holds: Sequence[Hold]) -> tuple[Array, Array]:
        """Gap to what is ahead (m) and speed of closing in (m/s) of every driver."""
        occupied = self.occupies()
        # Who is in two lanes during a change has a leader in each; the nearer one counts.
        shared = (occupied[:, None] & occupied[None]).any(axis=2)
        gaps = self.front[None] - self.length[None] - self.front[:, None]
        gaps = np.where(shared & (self.front[None] > self.front[:, None]), gaps, math.inf)
        leader = gaps.argmin(axis=1)
        gap = gaps[np.arange(len(gaps)), leader]
        # Without a leader there is nothing to close in on.
        closing = np.where(np.isfinite(gap), self.speed - self.speed[leader], 0.0)
        # A red light is a vehicle that stands, for all who can still stop before it.
        for hold in holds:
            if hold.begin <= self.time < hold.end:
                distance = hold.place - self.front
                # Who cannot stop any more drives on.
                stops = (distance > self.speed**2 / (2 * _HARDEST)) & (distance < gap)
                gap, closing = np.where(stops, distance, gap), np.where(stops, self.speed, closing)
        return gap, closing

    def _has_room(self, index: int, lane: int) -> bool:
        others = self.occupies()[:, lane]
        # Nobody is in the way of oneself.
        others[index] = False
        ahead = self.front - self.length - self.front[index]
        behind = self.front[index] - self.length[index] - self.front
        return not (others & (ahead < _ROOM_AHEAD) & (behind < _ROOM_BEHIND)).any()


def simulate(
    drivers: Sequence[Driver],
    lanes: int,
    frame_count: int,
    frame_rate: float,
    holds: Sequence[Hold] = (),
    *,
    changing: bool = False,
) -> Flow:
    """Let drivers follow each other (intelligent driver model) for `frame_count` frames.

    Parameters
    ----------
    drivers : sequence of Driver
        The drivers, of one direction.
    lanes : int
        Number of lanes of the one direction.
    frame_count : int
        Number of frames.
    frame_rate : float
        Frames per second.
    holds : sequence of Hold
        Red lights, for all lanes.
    changing : bool
        Let drivers overtake slower ones.
    """
    if not drivers:
        return Flow(np.empty((0, frame_count)), np.empty((0, frame_count)))
    traffic = _Traffic(drivers, lanes, 1 / frame_rate)
    front, lane = np.empty((2, len(drivers), frame_count))
    for index in range(frame_count):
        # Noted before the step: frame 0 is as the drivers were placed.
        front[:, index] = traffic.front
        lane[:, index] = traffic.lane
        if changing:
            traffic.change_lanes()
        traffic.step(holds)
    return Flow(front, lane)
