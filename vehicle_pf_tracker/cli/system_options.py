# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The systems of an evaluation: variants with their parameter sets, and baselines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.parameter_options import (
    ParameterSet,
    check_sets,
    configure,
    fitting_sets,
    read_sets,
    settable,
)
from vehicle_pf_tracker.cli.requests import option, positional, switch
from vehicle_pf_tracker.cli.shared_options import WorkersOption, natural, positive
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.baselines import MODELS, Baseline, unknown_baseline
from vehicle_pf_tracker.evaluation.grid.cells import BASELINE, BaselineSystem, System, VariantSystem
from vehicle_pf_tracker.parameters.table import Value, parse_assignments, to_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

if TYPE_CHECKING:
    from vehicle_pf_tracker.parameters.configuration import Configuration

SEEDS, FEW_SEEDS = 5, 1
"""Runs of each system; few where the cases vary more than the seeds of one case do."""
ALL, ALL_BASELINES = "all", "baselines"
_BASELINES_WITHOUT_MODELS = tuple(name for name, models in MODELS.items() if not models)


@dataclass(frozen=True, kw_only=True)
class EvaluationRequest(WorkersOption):
    """Request to compare systems, in any way."""

    sources: Sequence[str] = positional(
        nargs="+", metavar="REC",
        help="rosbag2 folder or MCAP file with truth, a folder of such, or a URL of one",
    )  # fmt: skip
    output: Path = option(
        "-o", type=Path, required=True, metavar="DIR",
        help="evaluation folder; finished runs in it are kept, the report is written anew",
    )  # fmt: skip
    seeds: int | None = option(
        type=positive, metavar="N",
        help=f"seeds of each stochastic system (default: {SEEDS}, or {FEW_SEEDS} where the "
        "cases vary more than seeds do)",
    )  # fmt: skip
    first_seed: int = option(type=natural, default=0, metavar="S", help="the first of the seeds")
    variants: str = option(
        default=ALL, metavar="NAME,…",
        help=f"what to compare: {', '.join(VARIANTS)}; {BASELINE}NAME of OpenCV's "
        f"{', '.join(MODELS)}; {ALL} (default) for all variants, {ALL_BASELINES} for "
        f"{', '.join(_BASELINES_WITHOUT_MODELS)}",
    )  # fmt: skip
    params: Sequence[str] = option(
        action="append", default=[], metavar="[VARIANT@]LABEL=FILE",
        help="run a parameter file too, under this label; for all variants that it fits, or one",
    )  # fmt: skip
    assignments: Sequence[str] = option(
        "--set", action="append", default=[],
        metavar="[[VARIANT@]LABEL:]NAME=VALUE",
        help="set a parameter: everywhere, or to make or complete the parameter set LABEL",
    )  # fmt: skip
    without_defaults: bool = switch(help="run the parameter sets alone, where a variant has any")
    baselines_python: Path | None = option(
        type=Path, metavar="FILE",
        help="interpreter of the baselines (default: .venv-baselines/bin/python, built by "
        "`make baselines`)",
    )  # fmt: skip
    baseline_model: Sequence[str] = option(
        action="append", default=[], metavar="BASELINE:NAME=FILE",
        help="model file of a baseline that needs some, as vit:net=vit.onnx; repeatable",
    )  # fmt: skip


def chosen(request: EvaluationRequest) -> tuple[list[System], list[str]]:
    """Return the systems that a request asks for, and notes about them.

    Raises
    ------
    InputError
        If a name, a file or a value does not fit.
    UsageError
        If an option is malformed.
    """
    words = _words(request.variants)
    variants = [find_variant(word) for word in words if not word.startswith(BASELINE)]
    everywhere, sets = read_sets(request.params, request.assignments)
    check_sets(variants, everywhere, sets)
    fitting, notes = fitting_sets(variants, sets)
    systems: list[System] = []
    for variant in variants:
        own = fitting[variant.name]
        defaults = [] if own and request.without_defaults else [ParameterSet("")]
        systems += [_variant_system(variant, each, everywhere) for each in [*defaults, *own]]
    models = _models(request.baseline_model)
    for word in words:
        if word.startswith(BASELINE):
            systems.append(
                _baseline_system(
                    word.removeprefix(BASELINE), request.baselines_python, models, notes
                )
            )
    return systems, notes


def _words(text: str) -> list[str]:
    words: list[str] = []
    for word in text.split(","):
        if word == ALL:
            words += VARIANTS
        elif word == ALL_BASELINES:
            words += [f"{BASELINE}{name}" for name in _BASELINES_WITHOUT_MODELS]
        elif word:
            words.append(word)
    if not words:
        raise UsageError(f"--variants names none; choose of {', '.join([*VARIANTS, ALL])}")
    return list(dict.fromkeys(words))


def _variant_system(
    variant: Variant, parameter_set: ParameterSet, everywhere: Iterable[str]
) -> VariantSystem:
    table = settable(variant)
    fitting = [word for word in everywhere if word.partition("=")[0] in table]
    overrides = parse_assignments(table, [*fitting, *parameter_set.assignments])
    configuration = configure(variant, parameter_set).updated(overrides)
    return make_system(variant, parameter_set.name, configuration, overrides)


def make_system(
    variant: Variant,
    parameter_set: str,
    configuration: Configuration,
    overrides: Mapping[str, Value],
) -> VariantSystem:
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
    values = {**to_mapping(configuration.tracker), **to_mapping(configuration.session)}
    label = f"{variant.name}@{parameter_set}" if parameter_set else variant.name
    return VariantSystem(
        label, variant.name, parameter_set, tuple(overrides.items()),
        tuple((name, values[name]) for name in settable(variant)),
    )  # fmt: skip


def _models(words: Iterable[str]) -> dict[str, dict[str, str]]:
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
) -> BaselineSystem:
    if name not in MODELS:
        raise unknown_baseline(name, MODELS)
    own = models.get(name, {})
    files = {key: Path(path) for key, path in own.items()}
    build = ""
    try:
        with Baseline(name, python, files) as baseline:
            build = baseline.versions["opencv"]
    except InputError as error:
        notes.append(f"{BASELINE}{name} cannot run: {error}")
    interpreter = "" if python is None else str(python.absolute())
    return BaselineSystem(name, interpreter, tuple(sorted(own.items())), build)
