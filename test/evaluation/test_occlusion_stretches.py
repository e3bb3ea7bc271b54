# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stretches of frames that figures shade."""

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.occlusion_stretches import stretches

BOX = Box(100, 60, 20, 10)


def truths(text):
    """Truth from frame 1 on, by a letter each: n none, p partial, t total, - unknown."""
    kinds = {"n": Occlusion.NONE, "p": Occlusion.PARTIAL, "t": Occlusion.TOTAL}
    return {n: Truth(n, BOX, kinds[c]) for n, c in enumerate(text, start=1) if c != "-"}


def test_stretches_of_one_kind():
    assert stretches(truths("npttpn"), {Occlusion.TOTAL}) == [(3, 4)]
    assert stretches(truths("npttpn"), {Occlusion.PARTIAL}) == [(2, 2), (5, 5)]
