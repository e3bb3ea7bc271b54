# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tables of table II of the first paper: ours and the paper's numbers side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean, median
from typing import TypeAlias

from reproduction.apf import systems as apf
from reproduction.experiment import DataTable, Entry
from reproduction.numbers import counted, mean_and_spread, rank_correlation
from reproduction.scenes.paper_scenes import VIDEO_SCENES

LABELS = tuple(system.label for system in (*apf.APF_RIVALS, apf.APF))
"""The six, in the order of the paper's columns."""
# The paper's table II, px: a row a video, from 1 to 20, a column a tracker, ordered as `LABELS`.
_PRINTED_ROWS = (
    (85.83, 100.19, 87.34, 93.45, 86.83, 25.65),
    (64.41, 66.92, 63.76, 65.30, 62.42, 9.92),
    (147.80, 180.41, 148.43, 177.35, 144.32, 9.74),
    (133.47, 145.70, 135.67, 146.12, 130.51, 56.79),
    (132.50, 135.61, 133.15, 138.48, 131.14, 64.47),
    (132.53, 134.19, 134.47, 137.39, 130.24, 41.59),
    (134.73, 133.37, 136.23, 139.10, 132.26, 42.45),
    (73.47, 75.12, 72.52, 78.43, 72.26, 12.55),
    (74.18, 78.94, 73.37, 77.12, 73.46, 14.21),
    (74.56, 27.41, 75.33, 78.22, 71.64, 13.37),
    (57.11, 54.39, 53.34, 56.25, 58.24, 6.42),
    (55.36, 55.72, 55.73, 58.90, 58.83, 7.38),
    (54.78, 53.42, 52.98, 55.12, 57.64, 6.94),
    (56.12, 54.77, 53.60, 56.47, 56.34, 6.53),
    (50.73, 52.12, 51.44, 52.45, 50.23, 5.32),
    (52.21, 49.67, 48.82, 52.18, 49.77, 5.78),
    (49.90, 48.92, 49.19, 53.23, 48.45, 4.22),
    (51.23, 51.04, 52.30, 50.98, 51.02, 5.19),
    (5.75, 4.32, 3.67, 4.59, 4.34, 4.12),
    (4.82, 3.76, 2.72, 5.12, 3.82, 3.78),
)
PUBLISHED: Mapping[str, Mapping[str, float]] = {
    video: dict(zip(LABELS, row, strict=True))
    for video, row in zip(VIDEO_SCENES, _PRINTED_ROWS, strict=True)
}
"""The paper's RMSE in px, by video and by tracker."""
BESIDE = (apf.RELATIVE, apf.AS_PRINTED, *apf.OWN_LIKELIHOOD, *apf.LIBERTIES)
"""Systems that run on all videos beside the six."""

Errors: TypeAlias = Mapping[str, Mapping[str, Sequence[float]]]
"""RMSE of each seed, by scene and by tracker."""


def groups(videos: Errors) -> dict[str, list[str]]:
    """Return the videos that averages are taken over, by title."""
    total = [name for name in videos if "total" in VIDEO_SCENES[name].occlusion]
    others = [name for name in videos if name not in total]
    return {"average": list(videos), "total occlusion": total, "no total occlusion": others}


def averages(videos: Errors, names: Sequence[str], label: str) -> list[float]:
    """Average RMSE over the videos `names`, for each seed."""
    columns = zip(*(videos[name][label] for name in names), strict=True)
    return [fmean(column) for column in columns]


def video_table(videos: Errors) -> DataTable:
    """Put the paper's number in brackets behind each of ours."""
    rows: list[tuple[Entry, ...]] = [
        (
            name,
            VIDEO_SCENES[name].occlusion,
            *(
                f"{mean_and_spread(errors[label])} ({PUBLISHED[name][label]:.2f})"
                for label in LABELS
            ),
        )
        for name, errors in videos.items()
    ]
    for title, names in groups(videos).items():
        means = (
            f"{mean_and_spread(averages(videos, names, label))} "
            f"({fmean(PUBLISHED[name][label] for name in names):.2f})"
            for label in LABELS
        )
        rows.append((f"**{title}**", "", *means))
    ranks = rank_correlations(videos)
    rows.append(("rank correlation with the paper", "", *(f"{r:.2f}" for r in ranks.values())))
    return DataTable(("video", "occlusion", *LABELS), tuple(rows))


def rank_correlations(videos: Errors) -> dict[str, float]:
    """Correlate, for each of the six, our order of the videos with the paper's."""
    return {
        label: rank_correlation(
            [fmean(errors[label]) for errors in videos.values()],
            [PUBLISHED[name][label] for name in videos],
        )
        for label in LABELS
    }


def ratios(videos: Errors, label: str, rivals: Sequence[str]) -> dict[str, float]:
    """Return each video's median RMSE of `label` over that of the best rival."""
    return {
        name: median(errors[label]) / min(median(errors[rival]) for rival in rivals)
        for name, errors in videos.items()
    }


def published_ratio(video: str) -> float:
    """Return the paper's RMSE of APF over that of the best rival."""
    row = PUBLISHED[video]
    return row[apf.APF.label] / min(row[rival.label] for rival in apf.APF_RIVALS)


def ratio_table(videos: Errors) -> DataTable:
    """Compare how far APF is ahead of the best rival, which the scene's size does not change."""
    rivals = [rival.label for rival in apf.APF_RIVALS]
    by_form = {
        system.label: ratios(videos, system.label, rivals) for system in (apf.APF, apf.RELATIVE)
    }
    rows = tuple(
        (name, VIDEO_SCENES[name].occlusion, *(f"{of[name]:.2f}" for of in by_form.values()),
         f"{published_ratio(name):.2f}")
        for name in videos
    )  # fmt: skip
    return DataTable(("video", "occlusion", *by_form, "in the paper"), rows)


def beside_table(videos: Errors, recovered: Mapping[str, Sequence[bool]]) -> DataTable:
    """Average each tracker in each of its forms."""
    rows = tuple(
        (
            system.label,
            *(
                mean_and_spread(averages(videos, names, system.label))
                for names in groups(videos).values()
            ),
            counted(recovered[system.label]),
        )
        for system in (*apf.SIX_SYSTEMS, *BESIDE)
    )
    return DataTable(("tracker", *groups(videos), "recovered from total occlusions"), rows)
