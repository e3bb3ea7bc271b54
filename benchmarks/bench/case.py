"""One measured ratio, and the file that all of them go to."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """What ours and a peer took for the same work in one run.

    Attributes
    ----------
    name : str
        Words from the general to the special, divided by slashes.
    ours_ms, peer_ms : float
        Medians over the rounds, in ms of CPU time.
    ratio : float
        ``peer_ms / ours_ms``: above 1 ours is the cheaper one.
    spread : float
        Interquartile range of the ratio over the rounds.
    """

    name: str
    ours_ms: float
    peer_ms: float
    ratio: float
    spread: float

    @classmethod
    def of(cls, name: str, ours: Sequence[float], peer: Sequence[float]) -> Case:
        """Sum up the rounds, in seconds, of which each has one time of ours and one of the peer."""
        ours_ms, peer_ms = (statistics.median(times) * 1e3 for times in (ours, peer))
        ratios = [theirs / own for own, theirs in zip(ours, peer, strict=True)]
        return cls(name, ours_ms, peer_ms, peer_ms / ours_ms, interquartile_range(ratios))


def interquartile_range(values: Sequence[float]) -> float:
    """Distance of the quartiles; 0 for a single value."""
    if len(values) < 2:
        return 0.0
    low, _, high = statistics.quantiles(values, n=4, method="inclusive")
    return high - low
