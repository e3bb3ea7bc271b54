# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 5 of the third paper: passes and resampled particles in each frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.drawing.shading import shade_occlusions
from reproduction.numbers import median_and_range
from reproduction.resampling import systems as resampling
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES, Style

_PLACE = "section VI, figure 5"
_MOST_PASSES = 20
"""The paper's bound of passes a frame."""
_LOW = 5.0
"""Passes a frame that count as few."""
_AT_MOST = 0.2
"""Share of the conventional filter's particles that counts as far fewer."""
_RISE = 14
"""Frame after which the paper sees more particles resampled."""
_AFTER = 5
"""Frames from there until the vehicle is visible again."""
_MORE = 1.1
"""Ratio that counts as an increase: the range of the seeds' means is about a tenth."""

Means = dict[str, dict[str, float]]
"""Mean over the phase's frames and all seeds, by filter and phase."""


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the means over the seeds, and judge."""
    passes = {r: _means(results, size, r, "resampling_passes") for r in resampling.VIEWS}
    drawn = {r: _means(results, size, r, "resampled_particles") for r in resampling.VIEWS}
    table = ex.DataTable(
        ("filter", *resampling.PHASES),
        tuple(
            (f"{variant}, {interpretation}",
             *(f"{passes[interpretation][variant][name]:.1f} / "
               f"{drawn[interpretation][variant][name]:.0f}"
               for name in resampling.PHASES))
            for interpretation in resampling.VIEWS
            for variant in passes[interpretation]
        ),
    )  # fmt: skip
    return ex.Report(
        resampling.data(results, size),
        _figure(results, size),
        ex.ExperimentVerdict(
            _claims(results, size, passes, drawn),
            f"{resampling.SETTING} {len(size.seeds)} seeds; curves are their means, bands "
            "their ranges. A resampled particle is one that is drawn and weighed anew in a pass.",
        ),
        {
            "Passes a frame / resampled particles a frame by phase, "
            "mean over frames and seeds:": table
        },
    )


def _means(results: ex.Results, size: ex.Size, interpretation: str, scalar: str) -> Means:
    by_filter: Means = {}
    view = resampling.VIEWS[interpretation]
    for system in view.pair:
        values: dict[str, list[float]] = {name: [] for name in resampling.PHASES}
        for seed in size.seeds:
            column = resampling.trace(results, view, system, seed)[scalar]
            scored = resampling.run_scores(results, view, system, seed)
            for name, chosen in resampling.phases(scored).items():
                values[name] += [column[index] for index in chosen]
        by_filter[system.variant] = {name: fmean(of) for name, of in values.items()}
    return by_filter


def _figure(results: ex.Results, size: ex.Size) -> Figure:
    figure = Figure(figsize=(10, 5.6), layout="constrained")
    interpretations = {name: resampling.VIEWS[name] for name in (ex.PAPER_RULE, ex.PRINTED_RULE)}
    axes = figure.subplots(2, len(interpretations), sharex=True, sharey="row")
    for column, (interpretation, view) in enumerate(interpretations.items()):
        for row, scalar in enumerate(("resampling_passes", "resampled_particles")):
            ax = axes[row, column]
            shade_occlusions(ax, resampling.run_scores(results, view, view.pair[0], size.seeds[0]))
            for system, style in zip(
                reversed(view.pair), (LINE_STYLES[0], LINE_STYLES[1]), strict=True
            ):
                runs = [resampling.trace(results, view, system, s)[scalar] for s in size.seeds]
                _draw(ax, [run[1:] for run in runs], style, system.variant)
        axes[0, column].set(title=interpretation)
        axes[1, column].set(xlabel="frame")
    axes[0, 0].set(ylabel="passes")
    axes[1, 0].set(ylabel="resampled particles")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw(axes: Axes, runs: Sequence[Sequence[float]], style: Style, label: str) -> None:
    """Draw the mean and the range over the seeds of what was counted from frame 2 on."""
    columns = list(zip(*runs, strict=False))
    frames = range(2, len(columns) + 2)
    axes.fill_between(
        frames,
        [min(of) for of in columns],
        [max(of) for of in columns],
        color=style.colour,
        alpha=0.15,
        lw=0,
    )
    axes.plot(
        frames,
        [fmean(of) for of in columns],
        color=style.colour,
        ls=style.line,
        lw=1.8,
        label=label,
    )


def _claims(
    results: ex.Results, size: ex.Size, passes: dict[str, Means], particles: dict[str, Means]
) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "the adaptive filter takes fewer passes and resamples fewer particles than the "
            "conventional one, in every phase",
            _PLACE,
            tuple(
                _fewer(interpretation, passes[interpretation], particles[interpretation])
                for interpretation in resampling.VIEWS
            ),
            "yes: by the means of both, in all phases; partly: of one, in one phase",
        ),
        ex.Claim(
            f"once the vehicle is hidden the conventional filter takes all {_MOST_PASSES} passes, "
            "and goes on to when it can be seen again",
            _PLACE,
            tuple(
                _endless(interpretation, by_filter) for interpretation, by_filter in passes.items()
            ),
            f"yes: the means while hidden and after are 95 % of {_MOST_PASSES} passes, and more "
            "than before; partly: one of them is 95 %",
        ),
        ex.Claim(
            "the adaptive filter's passes stay few in all phases",
            _PLACE,
            tuple(_few(interpretation, by_filter) for interpretation, by_filter in passes.items()),
            f"yes: at most {_LOW:g} a frame (mean); partly: in one phase",
        ),
        ex.Claim(
            f"after frame {_RISE} the filters resample more particles",
            "section VI, figure 5",
            tuple(
                _rises(interpretation, _around(results, size, interpretation))
                for interpretation, view in resampling.VIEWS.items()
                if view.scene == resampling.SCENE
            ),
            f"yes: the mean of the {_AFTER} frames after it is above that of those before by "
            f"{_MORE - 1:.0%} for both; partly: for one",
        ),
        ex.Claim(
            "(not in the paper in numbers) it resamples at most a fifth of the particles that the "
            "conventional one does",
            _PLACE,
            tuple(
                _saving(interpretation, _counts(results, size, interpretation))
                for interpretation in resampling.VIEWS
            ),
            "yes: with every seed; partly: by the means",
        ),
    )


def _fewer(interpretation: str, of_passes: Means, of_particles: Means) -> ex.Finding:
    passes, particles = (
        (of[resampling.ADAPTIVE], of[resampling.CONVENTIONAL]) for of in (of_passes, of_particles)
    )
    less = [own[name] < other[name] for own, other in (passes, particles) for name in own]
    parts = "; ".join(
        f"{name}: {passes[0][name]:.1f} passes and {particles[0][name]:.0f} particles against "
        f"{passes[1][name]:.1f} and {particles[1][name]:.0f}"
        for name in resampling.PHASES
    )
    return ex.Finding(interpretation, ex.Holds.of(all(less), any(less)), parts)


def _endless(interpretation: str, by_filter: Means) -> ex.Finding:
    own = by_filter[resampling.CONVENTIONAL]
    full = [own[name] >= 0.95 * _MOST_PASSES for name in ("full", "after")]
    rises = own["full"] > own["before"]
    parts = ", ".join(f"{name} {own[name]:.1f}" for name in resampling.PHASES)
    return ex.Finding(
        interpretation, ex.Holds.of(all(full) and rises, any(full)), f"passes a frame: {parts}"
    )


def _few(interpretation: str, by_filter: Means) -> ex.Finding:
    own = by_filter[resampling.ADAPTIVE]
    few = [own[name] <= _LOW for name in resampling.PHASES]
    parts = ", ".join(f"{name} {own[name]:.1f}" for name in resampling.PHASES)
    return ex.Finding(interpretation, ex.Holds.of(all(few), any(few)), f"passes a frame: {parts}")


def _around(
    results: ex.Results, size: ex.Size, interpretation: str
) -> Mapping[str, tuple[float, float]]:
    """Mean of the particles resampled a frame up to the rise, and after it, by filter."""
    view = resampling.VIEWS[interpretation]
    by_filter = {}
    for system in view.pair:
        runs = [
            resampling.trace(results, view, system, seed)["resampled_particles"]
            for seed in size.seeds
        ]
        # The first frame has no step.
        before = fmean(value for run in runs for value in run[1:_RISE])
        after = fmean(value for run in runs for value in run[_RISE : _RISE + _AFTER])
        by_filter[system.variant] = before, after
    return by_filter


def _rises(interpretation: str, by_filter: Mapping[str, tuple[float, float]]) -> ex.Finding:
    higher = [after >= _MORE * before for before, after in by_filter.values()]
    parts = ", ".join(
        f"{variant} {before:.0f}, then {after:.0f}"
        for variant, (before, after) in by_filter.items()
    )
    return ex.Finding(
        interpretation, ex.Holds.of(all(higher), any(higher)), f"particles a frame: {parts}"
    )


def _counts(results: ex.Results, size: ex.Size, interpretation: str) -> Sequence[tuple[int, int]]:
    """Particles that the adaptive and the conventional filter resample in each run."""
    view = resampling.VIEWS[interpretation]
    return [
        (
            resampling.resampled(results, view, view.adaptive, seed),
            resampling.resampled(results, view, view.conventional, seed),
        )
        for seed in size.seeds
    ]


def _saving(interpretation: str, counts: Sequence[tuple[int, int]]) -> ex.Finding:
    ratios = [own / max(others, 1) for own, others in counts]
    ours, theirs = (fmean(of) for of in zip(*counts, strict=True))
    return ex.Finding(
        interpretation,
        ex.Holds.of(max(ratios) <= _AT_MOST, ours / max(theirs, 1) <= _AT_MOST),
        f"{ours:.0f} against {theirs:.0f} a run; by seed {median_and_range(ratios, 3)} times",
    )


EXPERIMENT = ex.Experiment(
    "resampling-fig5", "Adaptive resampling, figure 5: passes and resampled particles",
    resampling.cells, report,
)  # fmt: skip
