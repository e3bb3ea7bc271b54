# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Text of the page of all experiments: the answer, every claim, its evidence, and the method."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

from reproduction.experiment import (
    BASIC_RIVALS,
    EXPERIMENT_SEEDS,
    OUR_INTERPRETATION,
    PAPER_RULE,
    PRINTED_RULE,
    Experiment,
    Holds,
)
from reproduction.paper import Paper

PICTURES = "images/reproduction"
"""Folder of the figures, beside the page."""
DATA = "reproduction.json"
"""File of the verdicts that the page is made of, beside it."""
_ADDED = "(not a claim of the paper's)"
"""Beginning of a claim that we test for the others' sake: it does not count."""

Verdict: TypeAlias = Mapping[str, Any]
"""Verdict on an experiment, as its folder has it."""
Claim: TypeAlias = Mapping[str, Any]
"""One claim of a verdict, with its findings."""

_PAGE = """# Reproduction of the papers' experiments

Do the trackers do what their papers say? Of {claims} claims {yes} hold here, {partly} hold in
part, and {no} do not.

{papers}

{gists}

The papers' videos are not public. The trackers ran on synthetic scenes with exact truth that stand
for them, so a claim that fails here may hold on the paper's own footage.

*The paper's rule* decides: the algorithm as it was meant, its misprints and gaps filled as
[interpretations.md](interpretations.md) says. *As printed* is the paper to the letter. *Our
interpretation* adds our extensions, or is the variant's default.

## Claims

Each was judged by a rule of its own, which stands beside its numbers under the link. Those of
apf-fig2, apf-table1 and mfpf-frames say only that our scenes show what the papers' do.

{overviews}

## Evidence

{index}

{sections}
## Method

`{command}` makes this page. The command above a figure made it, with as many runs of each kind as
it names, {usual} where it names none. `results/reproduce/NAME/` then has the rest of an experiment:
the setting, all tables and interpretations, every cell's data. [{data}]({data}) has the verdicts of
this page as data.

Values that a paper does not give were chosen on seeds above 99, which are not reported here. What
is neither *yes* nor *partly* by the rule of a claim is *no*.

{provenance}

{settings}"""


def page_text(
    papers: Sequence[Paper],
    verdicts: Mapping[str, Verdict],
    pictures: Mapping[str, str],
    command: str,
    provenance: str,
) -> str:
    """Write the page.

    Parameters
    ----------
    papers : sequence of Paper
        Each has a chapter, if any of its experiments has a verdict.
    verdicts, pictures : mapping
        Verdict, and name of the figure's file, by the experiment's name.
    command : str
        Makes everything on the page.
    provenance : str
        Versions of the code that the runs are of.
    """
    shown = [paper for paper in papers if any(_judged(paper, verdicts))]
    judged = [pair for paper in shown for pair in _judged(paper, verdicts)]
    counts = _counts(claim for _, verdict in judged for claim in verdict["claims"])
    sections = [
        _section(experiment, verdict, pictures[experiment.name]) for experiment, verdict in judged
    ]
    return _PAGE.format(
        claims=counts.total(),
        yes=counts[Holds.YES],
        partly=counts[Holds.PARTLY],
        no=counts[Holds.NO],
        papers=_papers_table(shown, verdicts),
        gists="\n".join(f"- **{paper.method}.** {paper.gist}" for paper in shown),
        overviews="\n\n".join(_overview(paper, verdicts) for paper in shown),
        index=_index(judged),
        sections="\n".join(sections),
        command=command,
        usual=EXPERIMENT_SEEDS,
        data=DATA,
        provenance=provenance,
        settings="\n".join(f"### Settings of {each.method}\n\n{each.settings}\n" for each in shown),
    )


def _judged(paper: Paper, verdicts: Mapping[str, Verdict]) -> Iterator[tuple[Experiment, Verdict]]:
    """Give the paper's experiments that have a verdict."""
    for experiment in paper.experiments:
        if experiment.name in verdicts:
            yield experiment, verdicts[experiment.name]


def _counts(claims: Iterator[Claim], interpretation: str | None = None) -> Counter[str]:
    """Count the papers' own claims by what the deciding finding, or that of a name, says."""
    return Counter(
        finding["holds"]
        for claim in claims
        if not claim["claim"].startswith(_ADDED)
        for finding in [
            claim["findings"][0] if interpretation is None else _finding(claim, interpretation)
        ]
        if finding is not None
    )


def _finding(claim: Claim, interpretation: str) -> Mapping[str, str] | None:
    """Return the claim's finding under an interpretation other than the first."""
    for finding in claim["findings"][1:]:
        if finding["interpretation"] == interpretation:
            named: Mapping[str, str] = finding
            return named
    return None


def _papers_table(papers: Sequence[Paper], verdicts: Mapping[str, Verdict]) -> str:
    head = ["paper", "claims", "hold", "in part", "do not", "hold as printed"]
    rows = []
    for paper in papers:
        claims = [claim for _, verdict in _judged(paper, verdicts) for claim in verdict["claims"]]
        decided = _counts(iter(claims))
        printed = _counts(iter(claims), PRINTED_RULE)
        numbers = [decided.total(), *(decided[holds] for holds in Holds)]
        as_printed = f"{printed[Holds.YES]} of {printed.total()}" if printed else "–"
        rows.append([paper.title, *map(str, numbers), as_printed])
    return _table(head, rows, numeric=5)


def _overview(paper: Paper, verdicts: Mapping[str, Verdict]) -> str:
    """List a paper's claims with their verdicts, without numbers."""
    judged = [
        (experiment, claim)
        for experiment, verdict in _judged(paper, verdicts)
        for claim in verdict["claims"]
    ]
    others = _other_interpretations([claim for _, claim in judged])
    rows = []
    for experiment, claim in judged:
        findings = [_finding(claim, name) for name in others]
        words = [finding["holds"] if finding else "–" for finding in findings]
        link = f"[{experiment.name}](#{experiment.name})"
        rows.append([claim["claim"], f"**{claim['findings'][0]['holds']}**", *words, link])
    return f"### {paper.title}\n\n{_table(['claim', PAPER_RULE, *others, 'evidence'], rows)}"


def _other_interpretations(claims: Sequence[Claim]) -> list[str]:
    named = {finding["interpretation"] for claim in claims for finding in claim["findings"][1:]}
    return [name for name in (BASIC_RIVALS, OUR_INTERPRETATION, PRINTED_RULE) if name in named]


def _index(judged: Sequence[tuple[Experiment, Verdict]]) -> str:
    """List the figures with the joint verdict on all claims of each."""
    rows = []
    for experiment, verdict in judged:
        basic = verdict["under"].get(BASIC_RIVALS)
        holds = f"**{verdict['holds']}**" + (f"; basic rivals: **{basic}**" if basic else "")
        link = f"[`{experiment.name}`](#{experiment.name})"
        rows.append([link, experiment.title, holds, _seeds(verdict["seeds"])])
    return _table(["figure", "what", "its claims together", "seeds"], rows)


def _seeds(seeds: Sequence[int]) -> str:
    return f"{seeds[0]} to {seeds[-1]}" if len(seeds) > 1 else f"{seeds[0]}"


def _section(experiment: Experiment, verdict: Verdict, picture: str) -> str:
    """Show an experiment's figure, and each claim with its rule and its findings."""
    rows = []
    for claim in verdict["claims"]:
        rows.append([f"**{claim['claim']}** ({claim['place']})", "", f"*{claim['rule']}*"])
        findings = claim["findings"]
        rows += [[each["interpretation"], each["holds"], each["numbers"]] for each in findings]
    parts = [
        f"### {experiment.name}\n`{verdict['command']}`",
        f"![{experiment.title}]({PICTURES}/{picture})",
        _table(["claim, and its interpretation", "holds", "rule, and result"], rows),
        *verdict["remarks"],
    ]
    return "\n\n".join(parts) + "\n"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], numeric: int = 0) -> str:
    """Write a Markdown table; its last `numeric` columns are aligned to the right."""
    rule = ["---"] * (len(head) - numeric) + ["---:"] * numeric
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (head, rule, *rows))
