# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""docs/parameters.md: what every node has, what several have, and each one's own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.table import EFFECTS, ParameterSpec
from vehicle_pf_tracker.trackers.registry import NODES, VARIANTS

_PREFACE = """# Parameters

Names, defaults and ranges are those of the nodes, of the files in config/ and of `--set`; integers
are accepted for doubles. `make config` writes this page. A parameter
of several variants stands once, under [Several variants](#several-variants).

The last column says what a change does while a target is followed:

"""


def parameters_page() -> str:
    """Return the text of the page."""
    tables = {name: Configuration.of(variant).specs() for name, variant in NODES.items()}
    owners: dict[ParameterSpec, list[str]] = {}
    for name in VARIANTS:
        for spec in tables[name].values():
            owners.setdefault(spec, []).append(name)
    common = {spec.name for spec, names in owners.items() if len(names) == len(VARIANTS)}
    every = {spec for spec in owners if spec.name in common}
    shared = {spec: names for spec, names in owners.items() if len(names) > 1 and spec not in every}
    effects = "".join(f"- *{name}*: {words}.\n" for name, words in EFFECTS.items())
    parts = [_PREFACE, effects, "\n## Every node\n", _table(s for s in owners if s in every)]
    parts += ["\n## Several variants\n", _table(shared, map(_listed, shared.values()))]
    for name, table in tables.items():
        own = [spec for spec in table.values() if spec not in every and spec not in shared]
        elsewhere = [spec.name for spec in table.values() if spec in shared]
        words = f"{NODES[name].summary}." + _also(elsewhere) + _lacking(table, common)
        parts.append(f"\n## {name}\n{words}\n" + (f"\n{_table(own)}" if own else ""))
    return "".join(parts)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _also(names: Sequence[str]) -> str:
    """Name the parameters of a variant that are in the table of several variants."""
    return f" It shares {_listed(names)} with other variants." if names else ""


def _lacking(table: Iterable[str], common: Iterable[str]) -> str:
    """Name the parameters of every node that this one does not have: `traffic` lacks some."""
    names = sorted(set(common).difference(table))
    return f" It does not have {_listed(names)}." if names else ""


def _table(table: Iterable[ParameterSpec], variants: Iterable[str] | None = None) -> str:
    """Write a row for each parameter, with the variants that have it where these are given."""
    head = "parameter", "default", "range", "unit", "what turning it does", "source", "at run time"
    rows = [head, ("---",) * len(head), *map(_row, table)]
    if variants is not None:
        column = ["variants", "---", *variants]
        rows = [(*row, cell) for row, cell in zip(rows, column, strict=True)]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _row(spec: ParameterSpec) -> tuple[str, ...]:
    default = str(spec.default).lower() if spec.kind is bool else str(spec.default)
    values = ", ".join(spec.choices) or spec.bounds_text
    effect = "start-up only" if spec.read_only else spec.effect
    cells = (f"`{spec.name}`", default, values, spec.unit, spec.doc, spec.source, effect)
    return tuple(cell.replace("|", "\\|") for cell in cells)
