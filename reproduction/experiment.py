# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""An experiment: the cells to run, and the report of their results: data, figure and verdict."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any, TypeAlias, TypeVar

from matplotlib.figure import Figure

from reproduction.runs.cells import Cell, Result

Entry: TypeAlias = float | int | str | None

PAPER_RULE = "the paper's rule"
"""The paper's algorithm as it was meant: misprints and gaps filled by docs/interpretations.md."""
BASIC_RIVALS = "the paper's rule, basic rivals"
"""The other open interpretation of P2: MFPF by the paper's rule beside single-feature filters that
have nothing of what its section IV adds (interpretation 32)."""
OUR_INTERPRETATION = "our interpretation"
"""The variant's defaults, or what we add to the paper's rule, named in the setting."""
PRINTED_RULE = "as printed"
"""The paper to the letter, misprints included."""


@dataclass(frozen=True, slots=True)
class DataTable:
    """Columns and rows."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Entry, ...], ...]

    def to_csv(self) -> str:
        """Keep every digit, and put nothing where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        return text.getvalue()

    def to_markdown(self, decimals: int = 1) -> str:
        """Round for the eye, the first column to the left and numbers to the right."""
        rules = ["---", *("---:" for _ in self.columns[1:])]
        rows = [[_shown(entry, decimals) for entry in row] for row in self.rows]
        lines = [list(self.columns), rules, *rows]
        return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _shown(entry: Entry, decimals: int) -> str:
    if entry is None:
        return "–"
    return f"{entry:.{decimals}f}" if isinstance(entry, float) else str(entry)


class Holds(str, Enum):
    """Verdict on a claim."""

    YES = "yes"
    PARTLY = "partly"
    NO = "no"

    @classmethod
    def share(cls, share: float, yes: float = 0.95, partly: float = 0.5) -> Holds:
        """Judge by the share of cases in which it is so."""
        return cls.of(share >= yes, share >= partly)

    @classmethod
    def of(cls, yes: bool, partly: bool = False) -> Holds:
        """Judge by two conditions, the stricter one first."""
        if yes:
            return cls.YES
        return cls.PARTLY if partly else cls.NO

    @classmethod
    def all(cls, parts: Iterable[Holds]) -> Holds:
        """Join: all alike keep their word, anything else is partly."""
        words = set(parts)
        return words.pop() if len(words) == 1 else cls.PARTLY


@dataclass(frozen=True, slots=True)
class Finding:
    """Result under one interpretation of the paper.

    Attributes
    ----------
    interpretation : str
        Name of the interpretation.
    holds : Holds
        Verdict under this interpretation.
    numbers : str
        The numbers that say so, with their spread.
    """

    interpretation: str
    holds: Holds
    numbers: str


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim, and how it is judged.

    Attributes
    ----------
    claim : str
        The claim in our words.
    place : str
        Its place in the paper.
    findings : tuple of Finding
        Results under each interpretation: the first one decides.
    rule : str
        Conditions of "yes" and "partly"; the verdict is "no" where neither is met.
    """

    claim: str
    place: str
    findings: tuple[Finding, ...]
    rule: str

    @property
    def judged(self) -> str:
        """The rule as a sentence."""
        return f"{self.rule}; no otherwise"


@dataclass(frozen=True, slots=True)
class ExperimentVerdict:
    """The judgement of one experiment.

    Attributes
    ----------
    claims : tuple of Claim
        Each is judged on its own.
    setting : str
        Set-up of the experiment, and choices where the paper is silent.
    remarks : tuple of str
        Further remarks, a sentence or two each.
    """

    claims: tuple[Claim, ...]
    setting: str
    remarks: tuple[str, ...] = ()

    @property
    def holds(self) -> Holds:
        """Joint verdict on all claims under the first interpretation, the paper's rule."""
        return Holds.all(claim.findings[0].holds for claim in self.claims)

    def under(self, interpretation: str) -> Holds | None:
        """Joint verdict under another interpretation; None if no claim was judged under it.

        A claim that depends on no interpretation counts under each.
        """
        named = [
            [f.holds for f in claim.findings if f.interpretation == interpretation]
            for claim in self.claims
        ]
        if not any(named):
            return None
        judged = [
            judgements[0] if judgements else claim.findings[0].holds
            for claim, judgements in zip(self.claims, named, strict=True)
            if judgements or len(claim.findings) == 1
        ]
        return Holds.all(judged)

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        others = {
            name: self.under(name) for name in (BASIC_RIVALS, OUR_INTERPRETATION, PRINTED_RULE)
        }
        under = {name: None if holds is None else holds.value for name, holds in others.items()}
        return {"holds": self.holds.value, "under": under, **asdict(self)}

    def to_markdown(self) -> str:
        """Return the text, with a table per claim."""
        parts = [f"**Verdict: {self.holds.value}.**", self.setting]
        for claim in self.claims:
            rows = ["| interpretation | holds | result |", "|---|---|---|"]
            rows += [
                f"| {f.interpretation} | **{f.holds.value}** | {f.numbers} |"
                for f in claim.findings
            ]
            text = f"Claim ({claim.place}): {claim.claim}. Judged: {claim.judged}."
            parts += [text, "\n".join(rows)]
        return "\n\n".join([*parts, *self.remarks]) + "\n"


T = TypeVar("T")
Results: TypeAlias = Mapping[Cell, Result]

EXPERIMENT_SEEDS = 10
"""Runs of each kind: with ten, a verdict that asks for 80 % of the seeds may lose two."""
QUICK_SEEDS = 2
"""Runs of a quick check: the least that have a spread."""


@dataclass(frozen=True, slots=True)
class Size:
    """Size of an experiment.

    Attributes
    ----------
    seeds : range
        Seeds of the runs. Verdicts come from 0 to 9; tuning uses others, from 100 on.
    quick : bool
        True for coarse grids, a check that everything works.
    """

    seeds: range = range(EXPERIMENT_SEEDS)
    quick: bool = False

    def of(self, full: T, quick: T) -> T:
        """Choose the value for the full or the quick size."""
        return quick if self.quick else full


@dataclass(frozen=True, slots=True)
class Report:
    """Report of an experiment.

    Attributes
    ----------
    data : DataTable
        Values of all cells.
    figure : Figure
        Figure after the paper's.
    verdict : ExperimentVerdict
        Verdicts on the claims.
    tables : mapping of str to DataTable
        Summaries to be read, by title.
    seeds : range or None
        Seeds that count here; None: those of the size.
    """

    data: DataTable
    figure: Figure
    verdict: ExperimentVerdict
    tables: Mapping[str, DataTable] = field(default_factory=dict)
    seeds: range | None = None


@dataclass(frozen=True, slots=True)
class Experiment:
    """One figure or table of a paper.

    Attributes
    ----------
    name : str
        Name on the command line.
    title : str
        Content in one line, with its place in the paper.
    cells : callable
        Gives the cells for a size.
    report : callable
        Makes the report from the results of those cells.
    """

    name: str
    title: str
    cells: Callable[[Size], Sequence[Cell]]
    report: Callable[[Results, Size], Report]
