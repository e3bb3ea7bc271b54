# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trials of a decision: `traffic` run over all clips with each of its values, and scored."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

from laboratory.result_store import ResultStore
from laboratory.traffic.camera_clips import Clip
from laboratory.traffic.decisions import Decision
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.case_run import follow
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters


def objective(scores: Mapping[str, float]) -> float:
    """Average HOTA and IDF1, percent."""
    # HOTA weighs detection and association alike, IDF1 how long identities are kept.
    return (scores["HOTA"] + scores["IDF1"]) / 2


def scores_of(
    decision: Decision, clips: Sequence[Clip], store: ResultStore, worker: TrafficWorker
) -> dict[float, dict[str, float]]:
    """Run all clips at every value: mean scores of each camera, by value; the shipped one first."""
    shipped = decision.get()
    without = () if decision.without is None else (decision.without,)
    by_value: dict[float, dict[str, float]] = {}
    # Shipped first: the table takes the first value for it.
    for value in dict.fromkeys((shipped, *decision.values, *without)):
        # All decisions share the run in which all are as shipped.
        name = "shipped" if value == shipped else f"{decision.place}={value:g}"
        cameras: dict[str, list[float]] = {}
        for clip in clips:
            run = name if decision.matters(clip.boxes) else "shipped"
            key = f"{run} {clip.sequence.folder.resolve()} {clip.boxes}"
            # Scored once for all decisions, and kept as soon as it is there.
            if key not in store:
                with decision.at(value):
                    tracks, _, _ = follow(clip.given, TrafficParameters())
                scores = worker.score(clip.sequence, tracks)
                store.add(key, key, {"HOTA": scores["HOTA"], "IDF1": scores["IDF1"]})
            cameras.setdefault(clip.camera, []).append(objective(store[key]))
        by_value[value] = {camera: statistics.fmean(each) for camera, each in cameras.items()}
    return by_value
