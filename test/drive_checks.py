# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Checks of the truth of a drive, of the package's, the laboratory's and the papers' scenes."""

from itertools import groupby

from vehicle_pf_tracker.core.truth import Occlusion

NONE, TOTAL = Occlusion.NONE, Occlusion.TOTAL


def phases(truths):
    """Runs of one state of occlusion, with their lengths."""
    return [(state, len(list(run))) for state, run in groupby(truth.occlusion for truth in truths)]


def check_room_to_recover(truths):
    """At least thirty frames are visible between two total occlusions, and after the last."""
    visible, had_total = 0, False
    for state, length in [*phases(truths), (TOTAL, 0)]:
        if state is not TOTAL:
            visible += length
            continue
        assert visible >= 30 or not had_total
        visible, had_total = 0, True


def check_target(scene, truths):
    """The target is clear at first, and inside an image of the papers' size and rate."""
    assert len(truths) == scene.frame_count
    assert 70 <= scene.frame_count <= 200
    assert (scene.width, scene.height) in {(640, 480), (768, 576)}
    assert scene.frame_rate == 15
    assert all(truth.occlusion is NONE for truth in truths[:5])
    for box in (truth.box for truth in truths):
        assert min(box.x, box.y) >= -1e-9
        assert box.x + box.width <= scene.width + 1e-9
        assert box.y + box.height <= scene.height + 1e-9
