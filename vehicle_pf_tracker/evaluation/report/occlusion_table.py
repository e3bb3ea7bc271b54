"""What became of the systems in each total occlusion of a recording."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.occlusions import OcclusionScore
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredRun


@dataclass(frozen=True, slots=True)
class OcclusionCell:
    """One system in one total occlusion, over its seeds.

    Attributes
    ----------
    recovered, judged : int
        Seeds after which it recovered, and seeds that are judged.
    exit_px : float or None
        Mean error at the exit.
    back : int
        Seeds in which the track came to stay on the vehicle.
    frames : float or None
        Their median number of frames until then.
    """

    recovered: int
    judged: int
    exit_px: float | None
    back: int
    frames: float | None


def occlusions_of(runs: Sequence[ScoredRun]) -> list[tuple[int, int]]:
    """Return the first and last hidden frames of all total occlusions that the runs saw."""
    return sorted({_key(o) for run in runs for o in run.metrics.occlusions})


def occlusion_cell(runs: Sequence[ScoredRun], occlusion: tuple[int, int]) -> OcclusionCell:
    """Draw the seeds of one system together."""
    found = [o for run in runs for o in run.metrics.occlusions if _key(o) == occlusion]
    verdicts = [o.recovered for o in found if o.recovered is not None]
    exits = [o.error_at_exit_px for o in found if o.error_at_exit_px is not None]
    frames = [o.frames_to_recover for o in found if o.frames_to_recover is not None]
    return OcclusionCell(
        recovered=sum(verdicts),
        judged=len(verdicts),
        exit_px=statistics.fmean(exits) if exits else None,
        back=len(frames),
        frames=statistics.median(frames) if frames else None,
    )


def _key(occlusion: OcclusionScore) -> tuple[int, int]:
    return occlusion.first_frame, occlusion.last_frame
