# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures 2 and 3 of the third paper: frames of both filters in the four phases."""

from __future__ import annotations

from reproduction import experiment as ex
from reproduction.drawing.strips import strip_figure
from reproduction.resampling import systems as resampling
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.scores import Scores

_PLACE = "section VI, figures 2 and 3"
_SHOWN = ex.PAPER_RULE, f"{ex.PAPER_RULE}{resampling.HARD}"
_JUDGED = (
    ex.PAPER_RULE,
    ex.OUR_INTERPRETATION,
    ex.PRINTED_RULE,
    f"{ex.PAPER_RULE}{resampling.HARD}",
    f"{ex.PRINTED_RULE}{resampling.HARD}",
)


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Show the first seed in the middle of each phase, and judge all seeds there."""
    seed = size.seeds[0]
    rows = {}
    for interpretation in _SHOWN:
        view = resampling.VIEWS[interpretation]
        runs = {
            system.variant: resampling.run_scores(results, view, system, seed)
            for system in view.pair
        }
        numbers = [index + 1 for index in _middles(runs[resampling.CONVENTIONAL])]
        rows[interpretation] = (view.scene.seeded(seed), runs, numbers)
    return ex.Report(
        resampling.data(results, size),
        strip_figure(rows),
        ex.ExperimentVerdict(
            (
                ex.Claim(
                    "the adaptive filter is on the vehicle in all four phases",
                    _PLACE,
                    tuple(
                        _on_it(r, _hits(results, size, r, resampling.ADAPTIVE), len(size.seeds))
                        for r in _JUDGED
                    ),
                    "yes: its estimate is in the true box in 80 % of the runs, in all four; "
                    "partly: in the first two",
                ),
                ex.Claim(
                    "the conventional filter is on it before and while it is partly hidden, and "
                    "stays at the parked vehicle afterwards",
                    _PLACE,
                    tuple(
                        _stuck(r, _hits(results, size, r, resampling.CONVENTIONAL), len(size.seeds))
                        for r in _JUDGED
                    ),
                    "yes: in the true box in 80 % of the runs in the first two, and in at most "
                    "20 % at the end; partly: one of both",
                ),
            ),
            f"{resampling.SETTING} {len(size.seeds)} seeds, judged in the middle frame of each "
            "phase and in the last frame of all; the picture shows the first seed, cut "
            "to what is around the true position; an arrow points to a filter that is elsewhere.",
        ),
    )


def _middles(scored: Scores) -> list[int]:
    """Return the index of the middle frame of each phase; of the last one the end."""
    phases = resampling.phases(scored)
    return [
        *(phases[name][len(phases[name]) // 2] for name in resampling.PHASES[:-1]),
        phases["after"][-1],
    ]


def _hits(results: ex.Results, size: ex.Size, interpretation: str, variant: str) -> list[int]:
    """Count the seeds whose estimate is within the true box, by phase."""
    view = resampling.VIEWS[interpretation]
    (system,) = (s for s in view.pair if s.variant == variant)
    hits = [0] * len(resampling.PHASES)
    for seed in size.seeds:
        scored = resampling.run_scores(results, view, system, seed)
        for place, index in enumerate(_middles(scored)):
            frame = scored.frames[index]
            assert frame.truth is not None
            hits[place] += _contains(frame.truth.box, frame.row.position)
    return hits


def _contains(box: Box, position: tuple[float, float] | None) -> bool:
    if position is None:
        return False
    x, y = position
    return box.x <= x <= box.x + box.width and box.y <= y <= box.y + box.height


def _numbers_text(hits: list[int], runs: int) -> str:
    phases = ", ".join(
        f"{name} {count}" for name, count in zip(resampling.PHASES, hits, strict=True)
    )
    return f"within the true box, of {runs} runs: {phases}"


def _on_it(interpretation: str, hits: list[int], runs: int) -> ex.Finding:
    enough = [count >= 0.8 * runs for count in hits]
    return ex.Finding(
        interpretation, ex.Holds.of(all(enough), all(enough[:2])), _numbers_text(hits, runs)
    )


def _stuck(interpretation: str, hits: list[int], runs: int) -> ex.Finding:
    on_it = all(count >= 0.8 * runs for count in hits[:2])
    lost = hits[-1] <= 0.2 * runs
    return ex.Finding(
        interpretation, ex.Holds.of(on_it and lost, on_it or lost), _numbers_text(hits, runs)
    )


EXPERIMENT = ex.Experiment(
    "resampling-frames", "Adaptive resampling, figures 2 and 3: frames of the four phases",
    resampling.cells, report,
)  # fmt: skip
