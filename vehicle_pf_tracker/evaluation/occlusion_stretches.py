# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stretches of frames with an occlusion, which figures shade."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping

from vehicle_pf_tracker.core.truth import Occlusion, Truth


def stretches(truths: Mapping[int, Truth], kinds: Collection[Occlusion]) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with an occlusion of these kinds.

    Truths are given by the number of their frame.
    """
    grouped = itertools.groupby(sorted(truths), lambda number: truths[number].occlusion in kinds)
    occluded = [list(numbers) for matches, numbers in grouped if matches]
    return [(numbers[0], numbers[-1]) for numbers in occluded]
