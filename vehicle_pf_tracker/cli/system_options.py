# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The systems of an evaluation: variants with their parameter sets, and baselines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from vehicle_pf_tracker.cli.console import UsageError, tell_notice
from vehicle_pf_tracker.cli.option_values import natural, positive
from vehicle_pf_tracker.cli.parameter_options import configure
from vehicle_pf_tracker.cli.requests import option, positional
from vehicle_pf_tracker.cli.shared_options import SchedulerOption, WorkersOption
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.baselines import BASELINE_MODELS, Baseline, unknown_baseline
from vehicle_pf_tracker.evaluation.systems import BASELINE_PREFIX, System
from vehicle_pf_tracker.parameters.configuration import Configuration, SessionParameters
from vehicle_pf_tracker.parameters.table import (
    ParameterSpec,
    Value,
    parse_assignments,
    specs,
    unknown_name,
)
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

if TYPE_CHECKING:
    from vehicle_pf_tracker.evaluation.grid.running import Runner

DEFAULT_SEEDS = 5
"""Runs of each system: enough to see a spread. An interval of the mean needs more."""
FEW_SEEDS = 1
"""Runs of each system where the cases vary more than the seeds of one case do."""
ALL = "all"
"""Word for all variants."""
ALL_BASELINES = "baselines"
"""Word for all baselines that need no files of networks."""
_BASELINES_WITHOUT_MODELS = tuple(name for name, models in BASELINE_MODELS.items() if not models)

Set: TypeAlias = tuple[list[Path], list[str]]
"""Files and assignments of a set of parameters."""


def parameter_sets(
    files: Iterable[str], assignments: Iterable[str]
) -> tuple[list[str], dict[str, Set]]:
    """Return the assignments that hold everywhere, and the sets of parameters by their labels.

    ``[VARIANT@][LABEL=]FILE`` is a set, labelled by the file's stem if not otherwise, and
    ``[VARIANT@]LABEL:NAME=VALUE`` makes or completes one.
    """
    everywhere: list[str] = []
    sets: dict[str, Set] = {}
    for word in files:
        label, file = word.split("=", 1) if "=" in word else (Path(word).stem, word)
        sets.setdefault(label, ([], []))[0].append(Path(file))
    for word in assignments:
        label = word.partition("=")[0].rpartition(":")[0]
        if label:
            sets.setdefault(label, ([], []))[1].append(word[len(label) + 1 :])
        else:
            everywhere.append(word)
    return everywhere, sets


def runner_of(request: SchedulerOption) -> Runner:
    """Return what runs cells where the request says: processes here, or a cluster's workers."""
    from vehicle_pf_tracker.evaluation.grid.running import on_cluster, on_this_machine

    if request.scheduler is None:
        return on_this_machine(request.workers)
    return on_cluster(request.scheduler, tell_notice)


def settable(variant: Variant) -> dict[str, ParameterSpec]:
    """Return the parameters that may differ between systems: neither seed nor target."""
    table = {**specs(variant.parameters), **specs(SessionParameters)}
    return {n: s for n, s in table.items() if n != "seed" and not n.startswith("target.")}


@dataclass(frozen=True, kw_only=True)
class EvaluationRequest(WorkersOption):
    """Request to compare systems, in any way."""

    sources: Sequence[str] = positional(
        nargs="+", metavar="REC",
        help="recording or folder of images, with truth, or a folder of such",
    )  # fmt: skip
    output: Path = option(
        "-o", required=True, metavar="DIR",
        help="evaluation folder; finished runs in it are kept, the report is written anew",
    )  # fmt: skip
    seeds: int | None = option(
        type=positive, metavar="N",
        help=f"runs of each variant that draws random numbers (default: {DEFAULT_SEEDS}, or "
        f"{FEW_SEEDS} with --traffic)",
    )  # fmt: skip
    first_seed: int = option(type=natural, default=0, metavar="S", help="the first of the seeds")
    variants: str = option(
        default=ALL, metavar="NAME,…",
        help=f"what to compare: {', '.join(VARIANTS)}, or a plug-in; {BASELINE_PREFIX}NAME of "
        f"OpenCV's {', '.join(BASELINE_MODELS)}; {ALL} (default) for all variants, "
        f"{ALL_BASELINES} for {', '.join(_BASELINES_WITHOUT_MODELS)}",
    )  # fmt: skip
    params: Sequence[str] = option(
        action="append", default=[], metavar="[[VARIANT@]LABEL=]FILE",
        help="run with this file of parameters too, named LABEL (default: the file's name) in the "
        "results; for all variants that it fits, or one",
    )  # fmt: skip
    assignments: Sequence[str] = option(
        "--set", action="append", default=[],
        metavar="[[VARIANT@]LABEL:]NAME=VALUE",
        help="set a parameter: everywhere, or to make or complete the parameter set LABEL",
    )  # fmt: skip
    baselines_python: Path | None = option(
        help="interpreter of the baselines (default: .venv-baselines/bin/python, else the one "
        "in your cache; without either, evaluate prints the command that builds it)",
    )  # fmt: skip
    baseline_model: Sequence[str] = option(
        action="append", default=[], metavar="BASELINE:NAME=FILE",
        help="model file of a baseline that needs some, as vit:net=vit.onnx; repeatable",
    )  # fmt: skip

    def some_seeds(self, usual: int) -> range:
        """Return the seeds, `usual` of them unless the user gives a number."""
        return range(self.first_seed, self.first_seed + (self.seeds or usual))


def asked_systems(request: EvaluationRequest) -> tuple[list[System], list[str]]:
    """Return the systems that a request asks for, and notes about them.

    Raises
    ------
    InputError
        If a name, a file or a value does not fit.
    UsageError
        If an option is malformed.
    """
    words = _words(request.variants)
    variants = [find_variant(word) for word in words if not word.startswith(BASELINE_PREFIX)]
    everywhere, sets = parameter_sets(request.params, request.assignments)
    known = {name for variant in variants for name in settable(variant)}
    for name in (word.partition("=")[0] for word in everywhere):
        if name not in known:
            raise InputError(unknown_name(name, known))
    systems, notes = _with_sets(variants, everywhere, sets)
    models = _models(request.baseline_model)
    baselines = [
        _baseline_system(
            word.removeprefix(BASELINE_PREFIX), request.baselines_python, models, notes
        )
        for word in words
        if word.startswith(BASELINE_PREFIX)
    ]
    return [*systems, *baselines], notes


def _words(text: str) -> list[str]:
    baselines = [f"{BASELINE_PREFIX}{name}" for name in _BASELINES_WITHOUT_MODELS]
    several = {ALL: list(VARIANTS), ALL_BASELINES: baselines, "": []}
    words = [name for word in text.split(",") for name in several.get(word, [word])]
    if not words:
        raise UsageError(f"--variants names none; choose of {', '.join([*VARIANTS, ALL])}")
    return list(dict.fromkeys(words))


def _with_sets(
    variants: Sequence[Variant], everywhere: Sequence[str], sets: Mapping[str, Set]
) -> tuple[list[System], list[str]]:
    """Return each variant with its defaults and the sets that fit it, and notes on the others."""
    outcomes = [
        (label, _variant_system(variant, everywhere, label.rpartition("@")[2], own))
        for variant in variants
        for label, own in {"": ([], []), **sets}.items()
        if label.rpartition("@")[0] in {"", variant.name}
    ]
    notes = [(label, outcome) for label, outcome in outcomes if isinstance(outcome, str)]
    fitting = {label for label, outcome in outcomes if isinstance(outcome, System)}
    for label in sets:
        if label not in fitting:
            why = (note for of, note in notes if of == label)
            missing = f"the parameter set {label} is for no variant among --variants"
            raise InputError(next(why, missing))
    systems = [outcome for _, outcome in outcomes if isinstance(outcome, System)]
    return systems, [note for _, note in notes]


def _variant_system(
    variant: Variant, everywhere: Sequence[str], label: str, own: Set
) -> System | str:
    """Return the variant with a set of parameters, or say why it does not fit."""
    table = settable(variant)
    files, assignments = own
    words = [word for word in everywhere if word.partition("=")[0] in table] + assignments
    try:
        values = parse_assignments(table, words)
        return make_system(variant, label, configure(variant, files, values), values)
    except InputError as error:
        if not label:
            raise
        return f"{variant.name} is not run with {label}: {error}"


def make_system(
    variant: Variant,
    parameter_set: str,
    configuration: Configuration,
    overrides: Mapping[str, Value],
) -> System:
    """Make the system of a variant with all that decides about it in `configuration`.

    Raises
    ------
    InputError
        If a target is configured.
    """
    if configuration.session.target.box is not None:
        raise InputError(
            f"the parameters {parameter_set} set target.*; an evaluation starts on the first true "
            "box of each recording"
        )
    values = configuration.to_mapping()
    own = tuple((name, values[name]) for name in settable(variant))
    return System.of_variant(variant.name, own, parameter_set, tuple(overrides.items()))


def _models(words: Iterable[str]) -> dict[str, dict[str, str]]:
    """Read the model files of baselines, by baseline and by the file's name in it."""
    models: dict[str, dict[str, str]] = {}
    for word in words:
        baseline, colon, rest = word.partition(":")
        name, equals, file = rest.partition("=")
        if not (colon and equals and file):
            raise UsageError(f"--baseline-model expects BASELINE:NAME=FILE, not {word!r}")
        models.setdefault(baseline, {})[name] = str(Path(file).absolute())
    return models


def _baseline_system(
    name: str, python: Path | None, models: dict[str, dict[str, str]], notes: list[str]
) -> System:
    """Make the system of a baseline, with a note where it cannot run here."""
    if name not in BASELINE_MODELS:
        raise unknown_baseline(name)
    own = models.get(name, {})
    build = ""
    try:
        with Baseline(name, python, {key: Path(path) for key, path in own.items()}) as baseline:
            build = baseline.versions["opencv"]
    except InputError as error:
        notes.append(f"{BASELINE_PREFIX}{name} cannot run: {error}")
    interpreter = "" if python is None else str(python.absolute())
    return System.of_baseline(name, interpreter, tuple(sorted(own.items())), build)
