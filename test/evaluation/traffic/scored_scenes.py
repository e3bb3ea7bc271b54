# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes of many vehicles whose truth is written down by hand."""

from pathlib import Path

import numpy as np

from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence


def scene(truth, size, hidden=None, ignored=(), frames=None):
    """A scene with truth rows (frame, identity, left, top, width, height), nothing hidden."""
    truth = np.array(truth, dtype=float).reshape(-1, 6)
    return TrafficSequence(
        folder=Path("scene"),
        frame_count=frames or int(truth[:, 0].max()),
        frame_rate=30,
        size=size,
        truth=truth,
        hidden=np.zeros(len(truth), dtype=bool) if hidden is None else np.array(hidden, dtype=bool),
        ignored=np.array(ignored, dtype=float).reshape(-1, 5),
        detections={},
    )
