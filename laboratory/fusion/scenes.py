# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion` on synthetic scenes: the table of laboratory/notes/fusion_scenes.md.

    python -m laboratory.fusion.scenes --seeds 10 -o scenes.md

A scene and the tracker on it have the same seed.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import cv2

from laboratory.scenes import make_scene
from laboratory.stress.scoring import Score, score_estimates
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.trackers.registry import find_variant

SCENES = (
    "bar", "bars", "bus", "cross", "bridge", "shadows", "braking", "turn", "turn_occluded",
    "clear", "illumination", "acceleration", "scale",
)  # fmt: skip
HEADER = (
    "scene", "RMSE visible, median, px", "on target", "recovered", "runs with all", "hidden",
    "clear", "false run",
)  # fmt: skip


def main() -> int:
    """Measure."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="SCENE")
    parser.add_argument("--seeds", type=int, default=10, help="number of seeds (default: 10)")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.md")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    rows: list[Sequence[str]] = []
    for name in args.scenes:
        scores = []
        for seed in range(args.seeds):
            scores.append(score_scene(name, seed))
            print(f"{name}, seed {seed}: {_summary(scores[-1])}", file=sys.stderr, flush=True)
        rows.append(_row(name, scores))
    table = markdown(HEADER, rows)
    print(table, end="")
    if args.output:
        write_text(args.output, table)
    return 0


def score_scene(name: str, seed: int) -> Score:
    """Score `fusion` on a scene, started on the first true box.

    Raises
    ------
    InputError
        If there is no such scene.
    """
    # Kept in memory: tracker and scores both need them.
    frames = list(make_scene(name, seed=seed).frames())
    return score_estimates([each.truth for each in frames], track(frames, seed))


def track(frames: Sequence[SceneFrame], seed: int) -> list[EstimateRow]:
    """Track the target of a scene with default parameters; one row for each frame."""
    variant = find_variant("fusion")
    parameters = from_mapping(variant.parameters, {"seed": seed})
    tracker = OfflineTracker(variant, parameters, first_truth=frames[0].truth)
    return list(tracker.rows((each.truth.stamp_ns, each.frame) for each in frames))


def _row(name: str, scores: Sequence[Score]) -> list[str]:
    # Scenes without a total occlusion have nothing to recover from.
    judged = [score for score in scores if score.judged]
    return [
        name,
        _spread((s.rmse_visible_px for s in scores), statistics.median),
        _spread(s.on_target for s in scores),
        _ratio(sum(s.recovered for s in judged), sum(s.judged for s in judged)),
        _ratio(sum(s.recovered == s.judged for s in judged), len(judged)),
        _spread(None if s.claimed_hidden is None else 1 - s.claimed_hidden for s in scores),
        _spread(s.doubted_in_full_view for s in scores),
        str(max(s.longest_false_tracking for s in scores)),
    ]


def _spread(
    values: Iterable[float | None], middle: Callable[[Sequence[float]], float] = statistics.fmean
) -> str:
    """Middle of the values, with the least and the largest where these differ when rounded."""
    known = [value for value in values if value is not None]
    if not known:
        return NO_SCORE
    # Compared as shown: a range of equal numbers says nothing.
    text, low, high = (f"{one:.2f}" for one in (middle(known), min(known), max(known)))
    return text if low == high else f"{text} ({low}-{high})"


def _ratio(part: int, whole: int) -> str:
    return f"{part} of {whole}" if whole else NO_SCORE


def _summary(score: Score) -> str:
    return ", ".join(f"{k} {v}" for k, v in zip(HEADER[1:], _row("", [score])[1:], strict=True))


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.scenes"))
