# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Confidence held against what came of it: reliability diagram and expected calibration error."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

BINS = 10
"""Bins of equal width over confidences 0 to 1, as Guo et al. 2017 draw them (with 15; a battery has
fewer frames than an image data set)."""


@dataclass(frozen=True, slots=True)
class Reliability:
    """Frames by their confidence, and how many of them were on target.

    Attributes
    ----------
    counts : tuple of int
        Frames in each bin.
    confidences : tuple of float
        Sum of their confidences.
    hits : tuple of int
        Frames on target among them.
    """

    counts: tuple[int, ...] = (0,) * BINS
    confidences: tuple[float, ...] = (0.0,) * BINS
    hits: tuple[int, ...] = (0,) * BINS

    @classmethod
    def of(cls, pairs: Sequence[tuple[float, bool]]) -> Reliability:
        """Sort (confidence, on target) pairs into bins."""
        if not pairs:
            return cls()
        confidence = np.clip([pair[0] for pair in pairs], 0.0, 1.0)
        hit = np.array([pair[1] for pair in pairs], float)
        # A confidence of 1 belongs to the last bin.
        bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
        sums = (np.bincount(bins, values, BINS) for values in (None, confidence, hit))
        counts, confidences, hits = (values.tolist() for values in sums)
        return cls(tuple(counts), tuple(confidences), tuple(map(round, hits)))

    @classmethod
    def pooled(cls, several: Iterable[Reliability]) -> Reliability:
        """Add up several."""
        every = list(several)
        if not every:
            return cls()
        return cls(
            tuple(map(sum, zip(*(each.counts for each in every), strict=True))),
            tuple(map(sum, zip(*(each.confidences for each in every), strict=True))),
            tuple(map(sum, zip(*(each.hits for each in every), strict=True))),
        )

    @property
    def frames(self) -> int:
        """Frames in all bins."""
        return sum(self.counts)

    @property
    def calibration_error(self) -> float | None:
        """Expected calibration error (ECE): mean gap between confidence and share on target.

        Each bin counts by its frames; None without any.
        """
        # Sums and not means: a bin's gap times its frames is the difference of its sums.
        gaps = zip(self.confidences, self.hits, strict=True)
        return sum(abs(c - h) for c, h in gaps) / self.frames if self.frames else None

    def diagram(self) -> list[dict[str, float]]:
        """List the points of the reliability diagram, bins without frames left out."""
        rows = zip(self.counts, self.confidences, self.hits, strict=True)
        return [
            {"frames": count, "confidence": confidence / count, "on_target": hits / count}
            for count, confidence, hits in rows
            if count
        ]

    @classmethod
    def from_json(cls, entry: dict[str, Any]) -> Reliability:
        """Read what `dataclasses.asdict` gave."""
        return cls(tuple(entry["counts"]), tuple(entry["confidences"]), tuple(entry["hits"]))
