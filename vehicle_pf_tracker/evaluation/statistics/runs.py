"""The value of one metric in every run of every system."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from typing import NamedTuple, TypeAlias


class RunKey(NamedTuple):
    """Which run of a system."""

    recording: str
    seed: int


Runs: TypeAlias = Mapping[str, Mapping[RunKey, float]]
"""Values by system and run; runs without a value are missing."""


def recording_means(runs: Mapping[RunKey, float]) -> dict[str, float]:
    """Return the mean over the seeds, by recording.

    Runs on one recording share its difficulties, so that only recordings count as independent.
    """
    by_recording: dict[str, list[float]] = {}
    for key, value in runs.items():
        by_recording.setdefault(key.recording, []).append(value)
    return {recording: statistics.fmean(values) for recording, values in by_recording.items()}


def paired_differences(
    first: Mapping[RunKey, float], second: Mapping[RunKey, float]
) -> dict[str, float]:
    """Return the mean of first minus second over the seeds that both have, by recording."""
    common = [key for key in first if key in second]
    return recording_means({key: first[key] - second[key] for key in common})
