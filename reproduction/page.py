# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Page of all experiments: verdict, figure, and the numbers of every claim."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reproduction.catalogue import Paper
from reproduction.experiment import (
    BASIC_RIVALS,
    EXPERIMENT_SEEDS,
    OUR_INTERPRETATION,
    PAPER_RULE,
    PRINTED_RULE,
    Experiment,
)
from reproduction.output import FIGURE, VERDICT
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.results.output_files import make_folder, write_text

PAGE = "reproduction.md"
"""File of the page."""
_PICTURES = "images/reproduction"
"""Folder of its figures, beside it."""
_HEAD = """# Reproduction of the papers' experiments

`{command}` makes this page. It runs the trackers on synthetic scenes with exact truth, which stand
for the papers' own videos; those are not public. The command above a figure made it, with as many
runs of each kind as it names, {usual} where it names none. All were made by the same code.
`results/reproduce/NAME/` then has the rest of an experiment: the setting, all tables and
interpretations, every cell's data.

A claim is judged under up to three interpretations. *The paper's rule* gives the verdict: the
algorithm as it was meant, its misprints and gaps filled as [interpretations.md](interpretations.md)
says, with values that were chosen on seeds above 99, which are not reported here. *Our
interpretation* adds our extensions, or is the default; *as printed* is the paper to the letter.

A claim's row ends with the rule of its verdict: what is neither yes nor partly is no.

{overview}
"""


def write_page(folder: Path, results: Path, papers: Sequence[Paper], command: str) -> Path:
    """Join the verdicts in `results` to a page in `folder`, with the figures beside it.

    Parameters
    ----------
    folder, results : Path
        Folders of the page, and of the experiments' own folders.
    papers : sequence of Paper
        Each has a chapter, if any of its experiments has been run.
    command : str
        Makes everything on the page.

    Raises
    ------
    InputError
        If it cannot be written, or if the experiments were not all made by the same code.
    """
    _check_same_code(results, papers)
    pictures = make_folder(folder / _PICTURES)
    overview = []
    parts = []
    for paper in papers:
        judged = [(e, _verdict(results, e)) for e in paper.experiments if _was_run(results, e)]
        overview += [_overview_row(*one) for one in judged]
        if judged:
            parts.append(f"## {paper.title}\n\n{paper.interpretations}\n")
        for experiment, verdict in judged:
            picture = _copy_smallest(results / experiment.name, pictures, experiment.name)
            parts.append(_section(experiment, verdict, picture))
    head = ["figure", "what", PAPER_RULE, OUR_INTERPRETATION, PRINTED_RULE, "seeds"]
    table = "\n".join([_row(head), _row(["---"] * len(head)), *overview])
    page = folder / PAGE
    top = _HEAD.format(command=command, usual=EXPERIMENT_SEEDS, overview=table)
    write_text(page, "\n".join([top, *parts]))
    return page


def _check_same_code(results: Path, papers: Sequence[Paper]) -> None:
    """Refuse a page whose rows could contradict each other, as they are of several versions."""
    experiments = [e for paper in papers for e in paper.experiments if _was_run(results, e)]
    by_code: dict[str, list[str]] = {}
    for experiment in experiments:
        by_code.setdefault(_verdict(results, experiment)["code"], []).append(experiment.name)
    if len(by_code) > 1:
        *_, rarest = sorted(by_code.values(), key=len, reverse=True)
        raise InputError(
            f"{', '.join(rarest)} in {results} were made by other code than the rest: run "
            "everything again, or name another folder with --output"
        )


def _was_run(results: Path, experiment: Experiment) -> bool:
    return (results / experiment.name / f"{VERDICT}.json").exists()


def _verdict(results: Path, experiment: Experiment) -> Mapping[str, Any]:
    path = results / experiment.name / f"{VERDICT}.json"
    found: Mapping[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def _overview_row(experiment: Experiment, verdict: Mapping[str, Any]) -> str:
    others = [verdict["under"][name] or "–" for name in (OUR_INTERPRETATION, PRINTED_RULE)]
    link = f"[`{experiment.name}`](#{experiment.name})"
    seeds = _seeds(verdict["seeds"])
    basic = verdict["under"].get(BASIC_RIVALS)
    holds = f"**{verdict['holds']}**" + (f"; basic rivals: **{basic}**" if basic else "")
    return _row([link, experiment.title, holds, *others, seeds])


def _seeds(seeds: Sequence[int]) -> str:
    return f"{seeds[0]} to {seeds[-1]}" if len(seeds) > 1 else f"{seeds[0]}"


def _section(experiment: Experiment, verdict: Mapping[str, Any], picture: str) -> str:
    parts = [
        f"### {experiment.name}\n`{verdict['command']}`",
        f"![{experiment.title}]({_PICTURES}/{picture})",
        _claims(verdict["claims"]),
        *verdict["remarks"],
    ]
    return "\n\n".join(parts) + "\n"


def _claims(claims: Sequence[Mapping[str, Any]]) -> str:
    """Give each claim a row: the deciding finding, then those of the other interpretations."""
    found = {finding["interpretation"] for claim in claims for finding in claim["findings"][1:]}
    others = [name for name in (BASIC_RIVALS, OUR_INTERPRETATION, PRINTED_RULE) if name in found]
    head = ["claim", PAPER_RULE if others else "result", *others, "verdict"]
    rows = [_row(head), _row(["---"] * len(head))]
    for claim in claims:
        first, *rest = claim["findings"]
        by_name = {finding["interpretation"]: _result(finding) for finding in rest}
        results = [_result(first), *(by_name.get(name, "–") for name in others)]
        rows.append(_row([f"{claim['claim']} ({claim['place']})", *results, claim["rule"]]))
    return "\n".join(rows)


def _result(finding: Mapping[str, Any]) -> str:
    return f"**{finding['holds']}**: {finding['numbers']}"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _copy_smallest(source: Path, target: Path, name: str) -> str:
    """Copy the figure in the format that takes less room, and return the copy's name."""
    figures = [source / f"{FIGURE}.{kind}" for kind in ("svg", "png")]
    smallest = min(figures, key=lambda path: path.stat().st_size)
    with output_errors(target):
        for kind in ("svg", "png"):
            (target / f"{name}.{kind}").unlink(missing_ok=True)
        shutil.copyfile(smallest, target / f"{name}{smallest.suffix}")
    return f"{name}{smallest.suffix}"
