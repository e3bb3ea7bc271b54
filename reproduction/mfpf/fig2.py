# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 2 of the second paper: from the particles' weights to the particles that go on."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.runs.cells import RunCell
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.filtering.weights import Weights, from_log
from vehicle_pf_tracker.trackers.papers.shared import LikelihoodParameters, log_likelihood

_PLACE = "section III-F, figure 2"
_EVENTS = 10
"""Particles in the picture: few enough to see each step."""
_DRAWS = 1000
"""Particles drawn with each seed."""
_SHOWN = 0.55
"""Uniform number whose way to its event is drawn; any would do."""
_LARGEST_DEVIATION = 4.0
"""Deviation of a frequency in standard deviations that chance alone exceeds in one of 1600 tables
of ten events."""
_SMALL = 0.01
"""Difference of a frequency from its weight that is not seen in a filter of 200 particles: two of
them."""
_SIGMA_V = 0.15
"""Deviation of P2's equation 10 (interpretation 31), that of MFPF in `systems`."""
_PRINTED = "multinomial"
"""The scheme of the paper's list (i) to (iii)."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run nothing: the scheme is tried by itself."""
    return []


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the events, and count how often each is drawn."""
    weights = _weights()
    counts = {
        scheme: np.sum([_counts(scheme, weights, seed) for seed in size.seeds], axis=0)
        for scheme in RESAMPLING_SCHEMES
    }
    total = _DRAWS * len(size.seeds)
    names = (_PRINTED, *(name for name in RESAMPLING_SCHEMES if name != _PRINTED))
    rows = tuple(
        (scheme, event + 1, float(weights[event]), float(counts[scheme][event]) / total)
        for scheme in names
        for event in range(_EVENTS)
    )
    claim = ex.Claim(
        "a standard uniform number is transformed to a particle by the cumulative sum of the "
        "weights, so that each particle is drawn as often as its weight says",
        _PLACE,
        tuple(_finding(name, weights, counts[name], total) for name in names),
        "yes: no frequency deviates by more than four standard deviations of a multinomial draw; "
        "partly: by no more than 0.01",
    )
    return ex.Report(
        ex.DataTable(("scheme", "event", "probability", "frequency"), rows),
        _figure(weights),
        ex.ExperimentVerdict((claim,), _setting(size)),
    )


def _weights() -> Weights:
    """Weigh ten particles whose coefficients fall evenly to either side of the best one."""
    distance = np.abs(np.arange(_EVENTS) - 0.6 * _EVENTS) / _EVENTS
    parameters = LikelihoodParameters(sigma_v=_SIGMA_V)
    return from_log(log_likelihood(1.0 - 0.25 * distance, parameters))[0]


def _counts(scheme: str, weights: Weights, seed: int) -> Array:
    drawn = RESAMPLING_SCHEMES[scheme](weights, _DRAWS, np.random.default_rng(seed))
    return np.bincount(drawn, minlength=_EVENTS).astype(float)


def _finding(scheme: str, weights: Weights, counts: Array, total: int) -> ex.Finding:
    spread = np.sqrt(total * weights * (1 - weights))
    worst = float(np.max(np.abs(counts - total * weights) / spread))
    name = f"{ex.PAPER_RULE}, {scheme}" if scheme != _PRINTED else ex.PAPER_RULE
    return ex.Finding(
        name,
        ex.Holds.of(worst <= _LARGEST_DEVIATION, _farthest(counts / total, weights) <= _SMALL),
        f"{total} draws: frequencies are at most {worst:.1f} standard deviations of a multinomial "
        f"draw from the weights (largest difference {_farthest(counts / total, weights):.4f})",
    )


def _farthest(frequencies: Array, weights: Weights) -> float:
    return float(np.max(np.abs(frequencies - weights)))


def _figure(weights: Weights) -> Figure:
    figure = Figure(figsize=(8, 4.4), layout="constrained")
    axes = figure.add_subplot()
    events = np.arange(1, _EVENTS + 1)
    cumulative = np.cumsum(weights)
    axes.bar(events, weights, 0.7, color="#B07D4B", ec="black", lw=0.6, label="weights")
    axes.step(
        [0.5, *(events + 0.5)],
        [0.0, *cumulative],
        where="pre",
        color="black",
        lw=1.6,
        label="cumulative sum",
    )
    _draw_transformation(axes, cumulative)
    axes.set(xlim=(0.5, _EVENTS + 0.5), ylim=(0, 1.02), xticks=events)
    axes.set(xlabel="event: the particle's number", ylabel="probability")
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    return figure


def _draw_transformation(axes: Axes, cumulative: Array) -> None:
    event = int(np.searchsorted(cumulative, _SHOWN)) + 1
    axes.plot(
        [0.5, event, event],
        [_SHOWN, _SHOWN, 0.0],
        color="#0072B2",
        ls="--",
        lw=1.6,
        label=f"from the uniform number {_SHOWN:g} to event {event}",
    )


def _setting(size: ex.Size) -> str:
    return (
        f"Ten particles with the weights of equation 10 (sigma {_SIGMA_V:g}) for coefficients that "
        f"fall to either side of the best; {_DRAWS} draws with each of the seeds "
        f"{size.seeds.start} to {size.seeds.stop - 1}. The paper's list is the multinomial scheme; "
        "the package's other schemes beside it."
    )


EXPERIMENT = ex.Experiment(
    "mfpf-fig2", "MFPF, figure 2: the weights' cumulative distribution in resampling", cells,
    report,
)  # fmt: skip
