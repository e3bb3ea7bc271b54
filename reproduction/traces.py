"""Runs held against the truth again, from what was recorded of them."""

from __future__ import annotations

import functools

from reproduction.cells import Result, RunCell, SceneChoice
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames

PATH = ("x", "y", "width", "height", "mode")
"""What a cell has to record for `scores`."""


def scores(cell: RunCell, result: Result) -> Scores:
    """Give the scores of every frame of a run, for figures and for what `metrics` does not have.

    Parameters
    ----------
    cell : RunCell
        Records `PATH` at least.
    result : Result
        What came out of it.
    """
    truths = _truths(cell.scene)
    columns = (result["trace"][name] for name in PATH)
    rows = [
        EstimateRow(number, truth.stamp_ns, x, y, width, height, mode, None, None, None)
        for number, (truth, x, y, width, height, mode) in enumerate(
            zip(truths, *columns, strict=True), start=1
        )
    ]
    return score_frames(rows, truths)


@functools.lru_cache(maxsize=512)
def _truths(scene: SceneChoice) -> list[Truth]:
    """Give the truth, which many trackers and figures share and which takes time to make."""
    return scene.truths()
