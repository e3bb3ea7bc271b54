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
    """Return the mean of first minus second over the seeds that both have, by recording.

    A system with one run on a recording, since it draws nothing, stands against all of the other's.
    """
    differences = {}
    for recording in dict.fromkeys(key.recording for key in first):
        one, other = _on(first, recording), _on(second, recording)
        if min(len(one), len(other)) > 1:
            common = one.keys() & other.keys()
            one, other = ({seed: runs[seed] for seed in common} for runs in (one, other))
        if one and other:
            differences[recording] = statistics.fmean(one.values()) - statistics.fmean(
                other.values()
            )
    return differences


def _on(runs: Mapping[RunKey, float], recording: str) -> dict[int, float]:
    return {key.seed: value for key, value in runs.items() if key.recording == recording}
