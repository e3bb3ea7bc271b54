"""The systems of an evaluation: variants with their parameter sets, and peers."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli import parameter_options
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.evaluation.grid.systems import PEER, PeerSystem, System, VariantSystem
from vehicle_pf_tracker.evaluation.peers.client import MODELS, Peer
from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.trackers.parameters import (
    ParameterSpec,
    Value,
    parse_assignments,
    specs,
    to_mapping,
    unknown_name,
)
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant
from vehicle_pf_tracker.trackers.session import SessionParameters

if TYPE_CHECKING:
    from vehicle_pf_tracker.ros.configuration import Configuration

ALL, ALL_PEERS = "all", "peers"
_PEERS_WITHOUT_MODELS = tuple(name for name, models in MODELS.items() if not models)


@dataclass(frozen=True)
class ParameterSet:
    """Parameters under a name; for one variant, or (None) for all whom they fit."""

    name: str
    variant: str | None = None
    files: list[Path] = field(default_factory=list)
    assignments: list[str] = field(default_factory=list)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that choose systems."""
    add = parser.add_argument
    add(
        "--variants", default=ALL, metavar="NAME,…",
        help=f"what to compare: {', '.join(VARIANTS)}; {PEER}NAME of OpenCV's {', '.join(MODELS)}; "
        f"{ALL} (default) for all variants, {ALL_PEERS} for {', '.join(_PEERS_WITHOUT_MODELS)}",
    )  # fmt: skip
    add(
        "--params", action="append", default=[], metavar="[VARIANT@]LABEL=FILE",
        help="run a parameter file too, under this label; for all variants that it fits, or one",
    )  # fmt: skip
    add(
        "--set", action="append", default=[], dest="assignments",
        metavar="[[VARIANT@]LABEL:]NAME=VALUE",
        help="set a parameter: everywhere, or to make or complete the parameter set LABEL",
    )  # fmt: skip
    add(
        "--without-defaults", action="store_true",
        help="run the parameter sets alone, where a variant has any",
    )  # fmt: skip
    add(
        "--peers-python", type=Path, metavar="FILE",
        help="interpreter of the peers (default: .venv-peers/bin/python, by `make peers`)",
    )  # fmt: skip
    add(
        "--peer-model", action="append", default=[], metavar="PEER:NAME=FILE",
        help="model file of a peer that needs some, as vit:net=vit.onnx; repeatable",
    )  # fmt: skip


def chosen(args: argparse.Namespace) -> tuple[list[System], list[str]]:
    """Return the systems that the options of `add_arguments` choose, and notes about them.

    Raises
    ------
    InputError
        If a name, a file or a value does not fit.
    UsageError
        If an option is malformed.
    """
    words = _words(args.variants)
    variants = [find_variant(word) for word in words if not word.startswith(PEER)]
    everywhere, sets = _parameter_sets(args)
    _check_sets(variants, everywhere, sets)
    fitting, notes = _fitting(variants, sets)
    systems: list[System] = []
    for variant in variants:
        own = fitting[variant.name]
        defaults = [] if own and args.without_defaults else [ParameterSet("")]
        systems += [_variant_system(variant, each, everywhere) for each in [*defaults, *own]]
    models = _models(args.peer_model)
    for word in words:
        if word.startswith(PEER):
            systems.append(_peer_system(word.removeprefix(PEER), args.peers_python, models, notes))
    return systems, notes


def _words(text: str) -> list[str]:
    words: list[str] = []
    for word in text.split(","):
        if word == ALL:
            words += VARIANTS
        elif word == ALL_PEERS:
            words += [f"{PEER}{name}" for name in _PEERS_WITHOUT_MODELS]
        elif word:
            words.append(word)
    if not words:
        raise UsageError(f"--variants names none; choose of {', '.join([*VARIANTS, ALL])}")
    return list(dict.fromkeys(words))


def _parameter_sets(args: argparse.Namespace) -> tuple[list[str], list[ParameterSet]]:
    """Return the assignments that hold everywhere, and the sets in the order they are named."""
    everywhere: list[str] = []
    sets: dict[str, ParameterSet] = {}

    def named(label: str) -> ParameterSet:
        variant, at, name = label.rpartition("@")
        if not name or (at and not variant):
            raise UsageError(f"{label!r} is no label of a parameter set: LABEL or VARIANT@LABEL")
        return sets.setdefault(label, ParameterSet(name, variant or None))

    for word in args.params:
        label, equals, file = word.partition("=")
        if not (equals and file):
            raise UsageError(f"--params wants LABEL=FILE, got {word!r}")
        named(label).files.append(Path(file))
    for word in args.assignments:
        label = word.partition("=")[0].rpartition(":")[0]
        if label:
            named(label).assignments.append(word[len(label) + 1 :])
        else:
            everywhere.append(word)
    return everywhere, list(sets.values())


def _check_sets(
    variants: Sequence[Variant], everywhere: Iterable[str], sets: Iterable[ParameterSet]
) -> None:
    names = [variant.name for variant in variants]
    for each in sets:
        if not names:
            raise InputError(
                f"the parameter set {each.name} is for no variant: there are only peers"
            )
        if each.variant is not None and each.variant not in names:
            raise InputError(
                f"the parameter set {each.variant}@{each.name} is for a variant that is not among "
                f"--variants {','.join(names)}"
            )
    known = {name for variant in variants for name in settable(variant)}
    for word in everywhere:
        name = word.partition("=")[0]
        if name not in known:
            raise InputError(unknown_name(name, known))


def _fitting(
    variants: Sequence[Variant], sets: Iterable[ParameterSet]
) -> tuple[dict[str, list[ParameterSet]], list[str]]:
    """Return the sets that each variant can run with, and notes on those that it cannot."""
    fitting: dict[str, list[ParameterSet]] = {variant.name: [] for variant in variants}
    notes = []
    for each in sets:
        named = [variant for variant in variants if each.variant in {None, variant.name}]
        misfits = {variant.name: _misfit(variant, each) for variant in named}
        reasons = [reason for reason in misfits.values() if reason]
        if len(reasons) == len(named):
            raise InputError(reasons[0])
        notes += reasons
        for name, reason in misfits.items():
            fitting[name] += [] if reason else [each]
    return fitting, notes


def _misfit(variant: Variant, parameter_set: ParameterSet) -> str:
    """Say why a variant cannot run with a set; empty if it can."""
    try:
        _configuration(variant, parameter_set)
    except InputError as error:
        return f"{variant.name} is not run with {parameter_set.name}: {error}"
    return ""


def _variant_system(
    variant: Variant, parameter_set: ParameterSet, everywhere: Iterable[str]
) -> VariantSystem:
    table = settable(variant)
    fitting = [word for word in everywhere if word.partition("=")[0] in table]
    overrides = parse_assignments(table, [*fitting, *parameter_set.assignments])
    configuration = _configuration(variant, parameter_set).updated(overrides)
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


def _configuration(variant: Variant, parameter_set: ParameterSet) -> Configuration:
    from vehicle_pf_tracker.ros.configuration import Configuration

    configuration = Configuration.of(variant)
    for file in parameter_set.files:
        configuration = parameter_options.with_file(configuration, variant, file)
    values = parse_assignments(settable(variant), parameter_set.assignments)
    return configuration.updated(values)


def settable(variant: Variant) -> dict[str, ParameterSpec]:
    """Everything that may differ between systems: not the seed, nor where the vehicle is."""
    table = {**specs(variant.parameters), **specs(SessionParameters)}
    return {n: s for n, s in table.items() if n != "seed" and not n.startswith("target.")}


def _models(words: Iterable[str]) -> dict[str, dict[str, str]]:
    models: dict[str, dict[str, str]] = {}
    for word in words:
        peer, colon, rest = word.partition(":")
        name, equals, file = rest.partition("=")
        if not (colon and equals and file):
            raise UsageError(f"--peer-model wants PEER:NAME=FILE, got {word!r}")
        models.setdefault(peer, {})[name] = str(Path(file).absolute())
    return models


def _peer_system(
    name: str, python: Path | None, models: dict[str, dict[str, str]], notes: list[str]
) -> PeerSystem:
    if name not in MODELS:
        raise InputError(f"there is no peer {name!r}; the peers are {', '.join(MODELS)}")
    own = models.get(name, {})
    files = {key: Path(path) for key, path in own.items()}
    build = ""
    try:
        with Peer(name, python, files) as peer:
            build = peer.opencv
    except InputError as error:
        notes.append(f"{PEER}{name} cannot run: {error}")
    interpreter = "" if python is None else str(python.absolute())
    return PeerSystem(name, interpreter, tuple(sorted(own.items())), build)
