# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Answers of one node to the images that were played, and why some have none."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.trackers.road_follower import ROAD_COLUMNS

DROPPED = "DROPPED"
"""Mode of a frame that a node never answered; all numbers are empty."""


@dataclass(frozen=True, slots=True)
class Losses:
    """Images without an answer.

    Attributes
    ----------
    busy : int
        Published while the node was at work on an earlier one: its queue was full.
    on_the_way : int
        Published while the node had answered all before: the middleware lost them, or the next one
        overtook them before the machine gave the node its turn.
    """

    busy: int = 0
    on_the_way: int = 0

    def __add__(self, other: Losses) -> Losses:
        return Losses(self.busy + other.busy, self.on_the_way + other.on_the_way)

    @property
    def total(self) -> int:
        """Number of images without an answer."""
        return self.busy + self.on_the_way

    def sentence(self, node: str, images: int) -> str:
        """Say why the node has not answered all of so many images, and what to do."""
        reasons = []
        if self.busy:
            reasons.append(f"{self.busy} came while it was at work on an earlier one")
        if self.on_the_way:
            reasons.append(
                f"{self.on_the_way} were lost on the way, or overtaken on a busy machine"
            )
        return (
            f"{node} did not answer {self.total} of {images} images: {'; '.join(reasons)}. "
            "In lock-step none is lost; at a lower rate, or with a larger queue_depth of the node, "
            "fewer are"
        )


class Answers:
    """Pairs the `~/mode` messages of one node with the images published, by stamp.

    Images of the same stamp are answered in the order in which they were published.

    Attributes
    ----------
    count : int
        Images answered, in all passes.
    """

    def __init__(self) -> None:
        self.count = 0
        self._earlier_losses = Losses()
        self._newest = 0
        self._newest_before: dict[int, int] = {}
        self._waiting: dict[int, deque[int]] = {}
        self._rows: dict[int, EstimateRow] = {}
        self._answers: dict[int, Mapping[str, str]] = {}

    def begin_pass(self) -> None:
        """Discard earlier frames; a loop begins again with their stamps."""
        self._earlier_losses = self.losses()
        self._newest = 0
        for kept in (self._waiting, self._rows, self._answers, self._newest_before):
            kept.clear()

    def expect(self, frame: int, stamp_ns: int) -> None:
        """Note that the image number `frame` was published."""
        self._rows[frame] = EstimateRow.without(frame, stamp_ns, DROPPED)
        self._waiting.setdefault(stamp_ns, deque()).append(frame)
        self._newest_before[frame] = self._newest

    def receive(self, message: Any) -> None:
        """Take a `DiagnosticArray` of `~/mode`; answers to other images are passed over."""
        stamp = stamp_ns(message.header)
        frames = self._waiting.get(stamp)
        if not frames or not message.status:
            return
        frame = frames.popleft()
        if not frames:
            del self._waiting[stamp]
        status = message.status[0]
        scalars = {"mode": status.message, **{pair.key: pair.value for pair in status.values}}
        self._rows[frame] = EstimateRow.from_scalars(frame, stamp, scalars)
        # All of a day would be gigabytes.
        self._answers[frame] = scalars if "road" in scalars else {}
        self._newest = max(self._newest, frame)
        self.count += 1

    def losses(self) -> Losses:
        """Count the images of all passes that have no answer (yet), by the reason."""
        busy = on_the_way = answered = 0
        for frame, newest_before in self._newest_before.items():
            if frame in self._answers:
                answered = frame
            elif newest_before < answered:  # its predecessor was answered after it had been sent
                busy += 1
            else:
                on_the_way += 1
        return self._earlier_losses + Losses(busy, on_the_way)

    def has(self, frame: int) -> bool:
        """Return whether image number `frame` of this pass was answered."""
        return frame in self._answers

    def road_columns(self) -> dict[str, list[float | None]]:
        """Return places and speeds on the road, a value for each of `rows`; none without a road."""
        answers = [self._answers.get(frame, {}) for frame in self._rows]
        if not any(answers):
            return {}
        return {
            name: [float(answer[name]) if name in answer else None for answer in answers]
            for name in ROAD_COLUMNS
        }

    def rows(self) -> tuple[EstimateRow, ...]:
        """One row for each image of this pass, in order."""
        return tuple(self._rows.values())
