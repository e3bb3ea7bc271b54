# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The metrics of a run that are shown to readers."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.metrics import Metrics


@dataclass(frozen=True, slots=True)
class Column:
    """A metric of a run.

    Attributes
    ----------
    key, group : str
        Name of the metric in files, and the group of columns it stands in.
    label, unit : str
        Name and unit for readers; shares have no unit.
    decimals : int
        Decimals shown to readers.
    higher_is_better : bool or None
        True if large values are best; None where neither end is.
    help : str
        Explanation, one sentence.
    by_recording : bool
        True if the page shows it for each recording, not only in the summary and in files.
    """

    key: str
    group: str
    label: str
    unit: str
    decimals: int
    higher_is_better: bool | None
    help: str
    by_recording: bool = True

    @property
    def title(self) -> str:
        """Label and unit."""
        return f"{self.label}, {self.unit}" if self.unit else self.label

    def value(self, metrics: Metrics) -> float | None:
        """Return the metric of a run; of occlusions the mean of those that have it."""
        # Of the run itself, or of each of its occlusions; `recovered` has both names.
        if hasattr(metrics, self.key) and self.key != "recovered":
            value: float | None = getattr(metrics, self.key)
            return None if value is None else float(value)
        known = [
            number
            for occlusion in metrics.occlusions
            if (number := getattr(occlusion, self.key)) is not None
        ]
        return sum(known) / len(known) if known else None


# Headings of the report, in the order in which it shows them.
OVERLAP = "Overlap and precision"
ERRORS = "Error of the centre"
HIDDEN = "Total occlusions"
CLAIMS = "Claims"
RUN = "Run"
RESTARTS = "With restarts after failure"

# The fields of a row are those of `Column`, in its order.
METRIC_COLUMNS = (
    Column("success_auc", OVERLAP, "success AUC", "", 3, True,
           "Area under the success curve: share of frames whose overlap (intersection over union) "
           "is above thresholds from 0 to 1."),
    Column("precision_20px", OVERLAP, "precision at 20 px", "", 3, True,
           "Share of frames with an error of the centre of at most 20 px."),
    Column("normalised_precision_auc", OVERLAP, "normalised precision AUC", "", 3, True,
           "Area under the curve of the error in sizes of the true box, from 0 to 0.5.", False),
    Column("p_error_lt_15px", OVERLAP, "below 15 px", "", 3, True,
           "Share of frames with an error below 15 px."),
    Column("on_target", OVERLAP, "on target", "", 3, True,
           "Share of visible frames with an error below half the true box's diagonal.", False),
    Column("rmse_px", ERRORS, "RMSE", "px", 1, False,
           "Root of the mean squared error of the centre, all scored frames."),
    Column("rmse_visible_px", ERRORS, "RMSE visible", "px", 1, False,
           "The same over the frames that are not totally occluded."),
    Column("median_px", ERRORS, "median", "px", 1, False, "Median error of the centre."),
    Column("p95_px", ERRORS, "95\u00a0%", "px", 1, False,
           "Error of the centre that 95 % of the frames stay below.", False),
    Column("max_px", ERRORS, "largest", "px", 1, False, "Largest error of the centre."),
    Column("recovered", HIDDEN, "recovered", "", 2, True,
           "Judged total occlusions after which the track was on the vehicle again: their number "
           "over all runs, or their mean share.", False),
    Column("frames_to_recover", HIDDEN, "return", "frames", 1, False,
           "Frames from the last hidden one until the track stays on the vehicle, where it does.",
           False),
    Column("error_at_exit_px", HIDDEN, "error at exit", "px", 1, False,
           "Error in the first frame after a total occlusion.", False),
    Column("occluded_precision", CLAIMS, "OCCLUDED precision", "", 2, True,
           "Share of the frames with the mode OCCLUDED that are totally occluded.", False),
    Column("occluded_recall", CLAIMS, "OCCLUDED recall", "", 2, True,
           "Share of the totally occluded frames with the mode OCCLUDED; baselines have none.",
           False),
    Column("lost_visible", CLAIMS, "LOST though visible", "frames", 1, None,
           "Frames with the mode LOST while the vehicle can be seen."),
    Column("failures", RUN, "failures", "", 1, False,
           "Times per run that the estimate came to have no overlap with a visible vehicle."),
    Column("step_ms_p50", RUN, "step", "ms", 2, False,
           "Median time of a step, measured while other cells of the grid may have run beside it."),
    Column("restart_accuracy", RESTARTS, "accuracy", "", 3, True,
           "Mean overlap of a second run, which starts anew from the truth after each failure; the "
           "first 10 frames of each start are left out."),
    Column("restart_failures", RESTARTS, "failures with restarts", "", 1, False,
           "Failures of that run: frames without overlap with a visible vehicle."),
    Column("restart_robustness", RESTARTS, "robustness", "", 3, True,
           "Chance of no failure in 100 visible frames of that run."),
)  # fmt: skip
_BY_KEY = {column.key: column for column in METRIC_COLUMNS}
SUCCESS, PRECISION, RMSE, RECOVERED, STEP = (
    _BY_KEY[key] for key in ("success_auc", "precision_20px", "rmse_px", "recovered", "step_ms_p50")
)

COMPARED_METRICS = (SUCCESS, PRECISION, RMSE)
"""Metrics that systems are compared by; the first one orders the tables."""
ONCE = tuple(column.key for column in METRIC_COLUMNS if column.group != RESTARTS)
"""Metrics of the run without restarts."""
BESIDE_RESTARTS = ("success_auc", "failures")
"""Metrics of that run which the table of the runs with restarts repeats."""
LATEX_METRICS = (SUCCESS, PRECISION, RMSE, RECOVERED, STEP)
"""Metrics of the LaTeX table."""


NO_VALUE = "–"
"""Sign of a value that does not exist, in tables for people."""


def number_text(value: float | None, decimals: int) -> str:
    """Return a number with so many decimals, a dash for None."""
    return NO_VALUE if value is None else f"{value:.{decimals}f}"
