# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle followed without ROS: frames in, one row per frame out."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeVar

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S, is_nearest, max_diff_ns
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.target_checks.stillness import Stillness
from vehicle_pf_tracker.image.target_checks.target_pixels import doubts
from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, EstimateRow
from vehicle_pf_tracker.trackers.attempts import TrackerError
from vehicle_pf_tracker.trackers.continuity import StrayImageError
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.localisation import Localisation
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.road_follower import ROAD_COLUMNS
from vehicle_pf_tracker.trackers.session import Session

ItemT = TypeVar("ItemT")


class OfflineTracker:
    """One variant on one stream of frames, as its node would do it.

    Parameters
    ----------
    variant : Variant
        Entry of the registry.
    parameters : Any
        An instance of `variant.parameters`.
    settings : SessionParameters
        A target in them is started on in the first frame.
    first_truth : Truth or None
        Truth whose box is the target where `settings` have none, in the frame that its stamp
        belongs to; the frames before are `WAITING`.
    targets : mapping of int to Box
        Boxes to start on, or to start again on, by the numbers of their frames. That of the first
        frame takes the place of the one in `settings`.
    max_diff : float
        Largest difference of stamps that belong together, in s.

    Attributes
    ----------
    session : Session
        Drives the tracker; it knows the seed in use.
    start_frame : int or None
        Number of the frame that the target was first set in; None until then.
    estimate : Estimate or None
        Estimate of the last frame; None where it has none.
    """

    def __init__(
        self,
        variant: Variant,
        parameters: Any,
        settings: SessionParameters | None = None,
        *,
        first_truth: Truth | None = None,
        targets: Mapping[int, Box] = MappingProxyType({}),
        max_diff: float = PAIRED_WITHIN_S,
    ) -> None:
        self.session = Session(variant, parameters, settings)
        self.start_frame: int | None = None
        self._notices = list(self.session.tracker.kernels.notices)
        # A target of the settings goes before: truth only starts what waits for one.
        self._first_truth = first_truth if self.session.waiting else None
        self._limit_ns = max_diff_ns(max_diff)
        road = self.session.settings.road
        has_road = road.fixed_plane() is not None
        self._localisation = Localisation(variant.name, road) if has_road else None
        self._on_road: list[Mapping[str, float]] = []
        self._off_road: Counter[str] = Counter()
        # A copy, from which each is taken: what is left was in no frame.
        self._targets = dict(targets)
        self._stillness = Stillness()
        self.estimate: Estimate | None = None

    def rows(
        self, frames: Iterable[tuple[int, Frame | None]], first: int = 1
    ) -> Iterator[EstimateRow]:
        """Track through (stamp in ns, frame) pairs, numbered from `first`; give a row for each.

        An image that could not be read has no frame, and is rejected as the node would reject it.

        Raises
        ------
        InputError
            If the target is invalid in the first frame, or no frame belongs to the first truth.
        """
        stamped = (StampedFrame(stamp_ns, frame) for stamp_ns, frame in frames)
        for number, (current, following) in enumerate(with_next(stamped), start=first):
            yield self.row(number, current, following, is_first=number == first)
        self.check_started()

    def row(
        self, number: int, current: StampedFrame, following: StampedFrame | None, *, is_first: bool
    ) -> EstimateRow:
        """Take the next frame, with its number and the one after it; see `rows`."""
        stamp_ns = current.stamp_ns
        frame = current.frame
        next_ns = None if following is None else following.stamp_ns
        # One entry for each row, also where the frame is rejected below: columns stay as long.
        self._on_road.append({})
        # The frame nearest to its stamp, which takes the frame after this one to know.
        truth = self._first_truth
        if truth and is_nearest(stamp_ns, next_ns, truth.stamp_ns, self._limit_ns):
            self._configure_target(truth.box)
            self._first_truth = None
        if (box := self._targets.pop(number, None)) is not None:
            # Configured, as if it had been in the settings: a recording that loops begins on it
            # again.
            if is_first:
                self._configure_target(box)
            else:
                self.session.set_target(box)
            reasons = [] if frame is None else doubts(frame, box)
            self._notices += [f"the target {box} is doubtful: {why}" for why in reasons]
        return self._estimated(number, stamp_ns, frame)

    def check_started(self) -> None:
        """Raise an `InputError` if no frame belonged to the first truth."""
        if self._first_truth is not None:
            raise InputError(
                f"no image is within {self._limit_ns / 1e9:g} s of the first truth, "
                f"at {self._first_truth.stamp_ns / 1e9:.3f} s; give a target with --target x,y,w,h"
            )

    @property
    def road_columns(self) -> dict[str, list[float | None]]:
        """Places and speeds on the road of all frames so far, by name; none without a road."""
        if self._localisation is None:
            return {}
        return {name: [scalars.get(name) for scalars in self._on_road] for name in ROAD_COLUMNS}

    @property
    def notices(self) -> list[str]:
        """Irregularities so far, a sentence each."""
        off_road = (
            f"no place on the road in {count} frame{'s' * (count > 1)}: {reason}"
            for reason, count in self._off_road.items()
        )
        return [*self._notices, *off_road, *map(unreached, self._targets.items())]

    def _configure_target(self, box: Box) -> None:
        """Start on `box`, and again where the recording loops."""
        settings = with_target(self.session.settings, box)
        self.session.reconfigure(self.session.tracker.parameters, settings)

    def _estimated(self, number: int, stamp_ns: int, frame: Frame | None) -> EstimateRow:
        """Feed a frame to the session, and return its row; a bad image is noted and rejected."""
        self.estimate = None
        if frame is None:
            return EstimateRow.without(number, stamp_ns, REJECTED_MODE)
        try:
            self.estimate = estimate = self.session.feed(frame, stamp_ns)
        except (InputError, TrackerError) as error:
            if self._ends_run(error):
                raise
            self._notices.append(f"frame {number} was rejected: {error}")
            return EstimateRow.without(number, stamp_ns, REJECTED_MODE)
        self._notices += [f"frame {number}: {event}" for event in self.session.events]
        if estimate is None:
            return EstimateRow.without(number, stamp_ns, WAITING_MODE)
        # The first only: a later target goes on with the same table.
        if self.start_frame is None:
            self.start_frame = number
        if estimate.begins:
            self._stillness.begin(estimate.box, stamp_ns)
        if estimate.mode is Mode.TRACKING:
            warnings = self._stillness.look(frame, estimate.box, stamp_ns)
            self._notices += [f"frame {number}: {sentence}" for sentence in warnings]
        self._locate(estimate, stamp_ns)
        return EstimateRow.from_scalars(number, stamp_ns, estimate.scalars())

    def _ends_run(self, error: InputError | TrackerError) -> bool:
        """Test whether an error ends the run, instead of rejecting one frame."""
        if isinstance(error, TrackerError):
            return error.persists
        # Before it has begun, an error is the user's target or source; later ones are single
        # images.
        return self.start_frame is None and not isinstance(error, StrayImageError)

    def _locate(self, estimate: Estimate, stamp_ns: int) -> None:
        """Keep an estimate's place and speed on the road, or count why it has none."""
        if self._localisation is None:
            return
        self._localisation.follow(estimate, stamp_ns, self.session.tracker.frame_period)
        if self._localisation.road is not None:
            self._on_road[-1] = self._localisation.road.scalars()
        else:
            self._off_road[self._localisation.objection] += 1


def unreached(target: tuple[int, Box]) -> str:
    """Say that the source ended before the frame of a target."""
    return f"the target {target[1]} is in frame {target[0]}, and no such frame was read"


def with_target(settings: SessionParameters, box: Box) -> SessionParameters:
    """Return `settings` with the target `box`."""
    return replace(settings, target=TargetParameters(box.x, box.y, box.width, box.height))


def with_next(items: Iterable[ItemT]) -> Iterator[tuple[ItemT, ItemT | None]]:
    """Yield each item with the one after it; None after the last."""
    for current, following in itertools.pairwise(itertools.chain(items, [None])):
        assert current is not None
        yield current, following
