"""The report of an evaluation: everything that is made from its folder alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.output_files import write_json, write_text
from vehicle_pf_tracker.evaluation.report import summary_files
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates, aggregate
from vehicle_pf_tracker.evaluation.report.estimate_recordings import write_estimate_recordings
from vehicle_pf_tracker.evaluation.report.page import make_page, styled
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, score_folder
from vehicle_pf_tracker.evaluation.report.trajectories import write_trajectories
from vehicle_pf_tracker.evaluation.report.video import write_videos


@dataclass(frozen=True, slots=True)
class ReportOptions:
    """What to make besides the page and the summaries.

    Attributes
    ----------
    images : bool
        Show stills of the recordings in the page.
    video : bool
        A video of each recording with boxes, in ``videos/``.
    recordings : bool
        Each recording with its truth and all estimates, in ``estimates/``.
    trajectories : bool
        TUM files of the truth and of all runs, in ``trajectories/``.
    """

    images: bool = True
    video: bool = False
    recordings: bool = False
    trajectories: bool = False


def write_report(
    folder: Path,
    options: ReportOptions | None = None,
    tell: Callable[[str], object] = lambda _: None,
) -> list[Path]:
    """Write the report of the evaluation in `folder` there; returns what was written, page first.

    The same folder gives the same files.

    Parameters
    ----------
    folder : Path
        Of an evaluation.
    options : ReportOptions or None
        What to make; None makes the page and the summaries.
    tell : callable
        Takes a sentence for each file that could not be made.

    Raises
    ------
    InputError
        If it is no folder of an evaluation, or cannot be written to.
    """
    options = options or ReportOptions()
    evaluation = score_folder(EvaluationFolder(folder))
    aggregates = aggregate(evaluation)
    page = folder / "report.html"
    write_text(page, make_page(evaluation, aggregates, images=options.images))
    written = [page, *_write_summaries(folder, evaluation, aggregates)]
    if options.trajectories:
        written += write_trajectories(evaluation)
    if options.recordings:
        written += write_estimate_recordings(evaluation, tell)
    if options.video:
        written += write_videos(evaluation, styled(aggregates), tell)
    return written


def _write_summaries(
    folder: Path, evaluation: ScoredEvaluation, aggregates: Aggregates
) -> list[Path]:
    texts = {
        "summary.md": summary_files.summary_markdown(evaluation, aggregates),
        "summary.csv": summary_files.summary_csv(evaluation, aggregates),
        "summary.tex": summary_files.summary_tex(aggregates),
    }
    for name, text in texts.items():
        write_text(folder / name, text)
    write_json(folder / "summary.json", summary_files.summary_json(evaluation, aggregates))
    return [folder / name for name in (*texts, "summary.json")]
