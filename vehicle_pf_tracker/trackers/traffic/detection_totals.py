# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Totals of what was detected, for a user who finds no vehicle."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.detection.detections import Detections


@dataclass(slots=True)
class DetectionTotals:
    """Totals of what was detected, for a user who finds no vehicle.

    Attributes
    ----------
    images : int
        Images with detections, or that a detector has looked at.
    disturbed : int
        Images that differed too much from those before.
    boxes : int
        Detections.
    outside : int
        Those of them that are outside the regions.
    ambiguous : int
        Images with blobs of which the detector is not sure how many vehicles they hold.
    latest : int or None
        Such blobs in the latest image; None where its detections are no blobs.
    sized : int
        Images in which it was known how large vehicles are.
    unresolved : float
        Sum over these of the vehicles in joined blobs that no followed one stands for, estimated by
        the blobs' size.
    latest_unresolved : float or None
        Such vehicles in the latest image; None where nobody knows.
    """

    images: int = 0
    disturbed: int = 0
    boxes: int = 0
    outside: int = 0
    ambiguous: int = 0
    latest: int | None = None
    sized: int = 0
    unresolved: float = 0.0
    latest_unresolved: float | None = None

    @property
    def mean_unresolved(self) -> float | None:
        """Mean number of vehicles in joined blobs without a number; None where nobody knows."""
        return self.unresolved / self.sized if self.sized else None

    def count(self, detections: Detections) -> None:
        """Count all that was detected in an image."""
        self.latest = detections.ambiguous if detections.are_shapes else None
        self.images += 1
        self.boxes += len(detections)
        self.ambiguous += detections.ambiguous > 0

    def count_inside(self, detections: Detections, inside: Detections) -> None:
        """Count what regions left of detections."""
        self.outside += len(detections) - len(inside)
        if inside.joined is not None:
            self.sized += 1
            self.latest_unresolved = float(inside.joined[:, 4].sum())
            self.unresolved += self.latest_unresolved
