# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles of a node: followed, counted, added and selected by hand.

The selected vehicle is reported as that of a single tracker is.
"""

from __future__ import annotations

import math
from collections import Counter as Tally
from collections.abc import Sequence

from vehicle_pf_tracker.core.box import Box, Position, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.following.counted_vehicles import CountedVehicles, session_and_counter
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.image.formats.encodings import LARGEST_SIDE_PX
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.library_memory import LINKER, give_back_library
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession

NO_VEHICLE = 0
"""Number that ends a selection; vehicles have numbers from 1."""
_SHOWN = 10
"""Numbers of vehicles that an error lists: a line of a log."""
_MOST_TARGETS = 100
"""Targets that may wait for the first image, or come between two: more are a mistake of a program,
and each would be followed."""


class Selection:
    """Number of the selected vehicle.

    Attributes
    ----------
    identity : int
        Its number; `NO_VEHICLE` where none is selected.
    """

    def __init__(self) -> None:
        self.identity = NO_VEHICLE

    def choose(self, identity: int, estimates: Sequence[TrackEstimate]) -> None:
        """Select a vehicle by its number; `NO_VEHICLE` selects none.

        Raises
        ------
        InputError
            If no vehicle has it.
        """
        numbers = [estimate.identity for estimate in estimates if estimate.identity]
        if identity != NO_VEHICLE and identity not in numbers:
            known = ", ".join(map(str, numbers[:_SHOWN])) + (", …" if numbers[_SHOWN:] else "")
            there = f"there are {known}" if numbers else "there is none"
            raise InputError(f"no vehicle has the number {identity}; {there}")
        self.identity = identity

    def choose_at(self, point: Position, estimates: Sequence[TrackEstimate]) -> None:
        """Select the vehicle at a point: of several the one with the smallest box.

        Raises
        ------
        InputError
            If there is none, within the size of a vehicle.
        """
        shown = [
            estimate
            for estimate in estimates
            if estimate.identity and estimate.mode is not TrackMode.LOST
        ]
        inside = [one for one in shown if _contains(one.box, point)]
        if inside:
            self.identity = min(inside, key=lambda one: (one.box.area, one.identity)).identity
            return
        near = [one for one in shown if math.dist(one.box.centre, point) < one.box.diagonal]
        if not near:
            raise InputError(f"there is no vehicle at {point[0]:g},{point[1]:g} px")
        self.identity = min(near, key=lambda one: math.dist(one.box.centre, point)).identity

    def of(self, estimates: Sequence[TrackEstimate]) -> TrackEstimate | None:
        """Return the estimate of the selected vehicle, where there is one."""
        chosen = self.identity
        return next(
            (estimate for estimate in estimates if chosen and estimate.identity == chosen), None
        )


def _contains(box: Box, point: Position) -> bool:
    x, y = point
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height


class Vehicles:
    """The vehicles of one stream of images.

    Parameters
    ----------
    configuration : Configuration
        Parameters of `TRAFFIC`.

    Attributes
    ----------
    counted : CountedVehicles
        Follows and counts them.
    latest : dict of str to Crossing
        Last crossing of each place.
    waiting : list of Box
        Targets that the first image will start.
    selection : Selection
        The vehicle that is reported like that of a single tracker.
    begins : bool
        True where the selected vehicle was given with the last image: its first estimate is that of
        the next.

    Raises
    ------
    InputError
        If the network, or the file of lines and zones, cannot be used, or a library is missing.
    """

    def __init__(self, configuration: Configuration) -> None:
        self.counted = CountedVehicles(*session_and_counter(configuration))
        # The session has linked its kernel.
        give_back_library(LINKER)
        self._configuration = configuration
        self.latest: dict[str, Crossing] = {}
        self.selection = Selection()
        self.begins = False
        self._is_shown = False
        self._added = 0
        self.waiting: list[Box] = []
        self._begun: list[Box] = []
        self._configured: Box | None = configuration.session.target.box

    @property
    def session(self) -> TrafficSession:
        """Session of the stream."""
        return self.counted.session

    @property
    def counter(self) -> Counter:
        """Counts at lines and in zones."""
        return self.counted.counter

    @property
    def estimates(self) -> tuple[TrackEstimate, ...]:
        """Estimates of the last image."""
        return self.counted.estimates

    @property
    def selected(self) -> TrackEstimate | None:
        """Estimate of the selected vehicle."""
        return self.selection.of(self.estimates)

    def feed(
        self, image: Frame | CodedImage, stamp_ns: int, detections: Detections | None
    ) -> list[str]:
        """Take the next image; returns its events, a sentence each.

        Raises
        ------
        InputError
            If the image cannot be used; all vehicles are kept.
        """
        crossings = self.counted.follow(image, stamp_ns, detections)
        if self.counted.has_begun_anew:
            self.selection.identity = self.session.successors.get(
                self.selection.identity, NO_VEHICLE
            )
            # After an error they are followed where they were; else nothing is known of them.
            if not self.session.recovered:
                self._configured = self._configuration.session.target.box
        for crossing in crossings:
            if not crossing.doubt:
                self.latest[crossing.place] = crossing
        self._is_shown = True
        self._added = 0
        return [*self.session.events, *self._add_waiting()]

    def add(self, box: Box) -> int | None:
        """Follow the vehicle in `box` of the last image; returns its number.

        Before the first image it waits for that, and has no number yet.

        Raises
        ------
        InputError
            If it cannot be followed there.
        """
        if max(self._added, len(self.waiting)) == _MOST_TARGETS:
            raise InputError(f"{_MOST_TARGETS} targets came without an image between them")
        if self._is_shown:
            identity = self.session.add(box)
            self._added += 1
            self._begun.append(box)
            return identity
        check_target(box, LARGEST_SIDE_PX, LARGEST_SIDE_PX)
        self.waiting.append(box)
        return None

    def take_begun(self) -> list[Box]:
        """Return the boxes of targets that were begun since the last call."""
        begun = self._begun
        self._begun = []
        return begun

    def select_first(self, box: Box) -> None:
        """Follow the vehicle in `box` of the next image, and select it."""
        self._configured = box

    def remove_selected(self) -> int:
        """Forget the selected vehicle, and return its number.

        Raises
        ------
        InputError
            If none is selected, or it is followed no more.
        """
        identity = self.selection.identity
        if not identity:
            raise InputError("no vehicle is selected")
        self.selection.identity = NO_VEHICLE
        if not self.session.remove(identity):
            raise InputError(f"the vehicle {identity} is not followed any more")
        return identity

    def reset(self) -> None:
        """Forget vehicles, counts and the images before; begin on the configured target."""
        self.session.reset()
        self.counted.begin_anew()
        self.selection.identity = NO_VEHICLE
        self._configured = self._configuration.session.target.box
        self._is_shown = False
        self.waiting.clear()
        self.latest.clear()
        self.counter.reset()

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images; no vehicle is lost by it."""
        before = self._configuration.session
        self._configuration = configuration
        if configuration.session.target != before.target:
            self._configured = configuration.session.target.box
        self.session.tracker.reconfigure(configuration.tracker)
        self.session.reconfigure(
            frame_rate=configuration.tracker.frame_rate,
            reset_on_time_jump=configuration.session.reset_on_time_jump,
        )
        if configuration.session.road != before.road:
            plane = configuration.session.road.fixed_plane()
            self.session.tracker.road = self.counter.plane = plane
            self.counter.forget_vehicles()

    def summary(self) -> dict[str, object]:
        """Count the vehicles by what is claimed of them, and those dropped for a bad state."""
        modes = Tally(estimate.mode for estimate in self.estimates)
        counts = {f"vehicles {mode.value}": modes[mode] for mode in TrackMode}
        dropped = self.session.tracker.bad_states
        return {"vehicles": len(self.estimates), **counts, "dropped for a bad state": dropped}

    def _add_waiting(self) -> list[str]:
        """Follow the targets that waited for an image, and select the configured one."""
        problems: list[str] = []
        boxes = self.waiting
        self.waiting = []
        configured = self._configured
        self._configured = None
        for box in boxes:
            self._try_to_add(box, problems)
        self.begins = configured is not None
        if configured is not None:
            self.selection.identity = self._try_to_add(configured, problems)
        return problems

    def _try_to_add(self, box: Box, problems: list[str]) -> int:
        """Return the number of the vehicle in `box`, or `NO_VEHICLE` with a problem."""
        try:
            identity = self.session.add(box)
        except InputError as error:
            problems.append(f"target refused: {error}")
            return NO_VEHICLE
        self._begun.append(box)
        return identity
