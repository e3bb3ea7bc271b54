# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Baselines of many vehicles, and scores of TrackEval, in a process of their own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.baseline_process import Worker
from vehicle_pf_tracker.evaluation.traffic.scorable import scorable
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence

_LOW = 0.25
"""Threshold of scores that suits CenterNet's on cdnet_highway, which span 0.15 to 0.74. It was
chosen by hand for that detector; the defaults of 0.6 and 0.7 discard nearly all of its boxes."""
_BOTH_LOW = {"track_activation_threshold": _LOW, "high_conf_det_threshold": _LOW}
TRAFFIC_BASELINES: Mapping[str, Mapping[str, float]] = {
    "sort": {},
    "sort-low": {"track_activation_threshold": 0.15},
    "bytetrack": {},
    "bytetrack-low": _BOTH_LOW,
    "ocsort": {},
    "ocsort-low": {"high_conf_det_threshold": _LOW},
    "cbiou": {},
    "cbiou-low": _BOTH_LOW,
}
"""Options of trackers of PyPI `trackers`: as they come, and with thresholds lowered by hand."""


class TrafficWorker(Worker):
    """A process that scores tracks and runs `TRAFFIC_BASELINES`.

    Parameters
    ----------
    python : Path or None
        Interpreter that has TrackEval and `trackers`; None looks where `baseline_python` says.

    Raises
    ------
    InputError
        If there is no such interpreter, or it lacks a library.
    """

    def __init__(self, python: Path | None = None) -> None:
        super().__init__("the traffic baselines", python, ["traffic"])

    def score(self, sequence: TrafficSequence, tracks: Array) -> dict[str, float]:
        """Score tracks (frame, identity, left, top, width, height) against a scene's truth.

        Returns
        -------
        dict of str to float
            HOTA, DetA, AssA, LocA, IDF1 and MOTA in percent; IDSW, Frag, FP and FN as counts.
        """
        truth, rows = scorable(sequence, tracks)
        content = {"truth": truth.tolist(), "tracks": rows.tolist()}
        answer: dict[str, float] = self._task("score", sequence, content)
        return answer

    def track(self, name: str, sequence: TrafficSequence, detections: Array) -> tuple[Array, float]:
        """Follow all vehicles with one of `TRAFFIC_BASELINES`.

        Returns
        -------
        tracks : array, shape (N, 6)
            Frame, identity, left, top, width, height.
        seconds : float
            Processor time per frame, s.
        """
        content = {
            "tracker": name.removesuffix("-low"),
            "options": {**TRAFFIC_BASELINES[name], "frame_rate": sequence.frame_rate},
            "detections": detections.tolist(),
        }
        answer = self._task("track", sequence, content)
        tracks = np.asarray(answer["tracks"], dtype=np.float64).reshape(-1, 6)
        return tracks, answer["seconds"] / sequence.frame_count

    def _task(self, task: str, sequence: TrafficSequence, content: dict[str, Any]) -> Any:
        return self._ask({task: {"frames": sequence.frame_count, **content}})
