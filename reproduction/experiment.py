"""What an experiment is: cells to run, and a report to make of their results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias, TypeVar

from matplotlib.figure import Figure

from reproduction.cells import Cell, Result
from reproduction.data_table import DataTable
from reproduction.verdict import Verdict

T = TypeVar("T")
Results: TypeAlias = Mapping[Cell, Result]

SEEDS, QUICK_SEEDS = 10, 2


@dataclass(frozen=True, slots=True)
class Size:
    """How large an experiment is made.

    Attributes
    ----------
    seeds : range
        Those of the runs. Verdicts come from 0 to 9; whoever tunes takes others, from 100 on.
    quick : bool
        Whether coarse grids are enough, to see that everything works.
    """

    seeds: range = range(SEEDS)
    quick: bool = False

    def of(self, full: T, quick: T) -> T:
        """Choose."""
        return quick if self.quick else full


@dataclass(frozen=True, slots=True)
class Report:
    """What an experiment shows.

    Attributes
    ----------
    data : DataTable
        All cells.
    figure : Figure
        Like the paper's.
    verdict : Verdict
        Whether the claims hold.
    tables : mapping of str to DataTable
        Summaries to be read, by title.
    """

    data: DataTable
    figure: Figure
    verdict: Verdict
    tables: Mapping[str, DataTable] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Experiment:
    """One figure or table of a paper.

    Attributes
    ----------
    name : str
        By which it is asked for.
    title : str
        What it is, in one line, with its place in the paper.
    cells : callable
        Gives the cells for a size.
    report : callable
        Makes the report from the results of those cells.
    """

    name: str
    title: str
    cells: Callable[[Size], Sequence[Cell]]
    report: Callable[[Results, Size], Report]
