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

"""The folder with the outcome of one experiment, and the document made of all of them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from reproduction.experiment import (
    OURS,
    PAPER,
    PRINTED,
    QUICK_SEEDS,
    SEEDS,
    Experiment,
    Report,
    Size,
)
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.evaluation.output_files import (
    make_folder,
    write_json,
    write_text,
)
from vehicle_pf_tracker.evaluation.plots import save
from vehicle_pf_tracker.evaluation.run_folder import versions

DATA, FIGURE, VERDICT = "data.csv", "figure", "verdict"
_PICTURES = "images/reproduction"
_HEAD = """# Reproduction of the papers' experiments

`{command}` makes everything on this page: it runs the trackers on
synthetic scenes with exact truth, draws the figures and writes the verdicts. Nothing here is
written by hand. The papers' own videos are not public, so every scene is a synthetic counterpart.
Beside each figure, `results/reproduce/<name>/` has all cells as `data.csv`.

Every claim is judged three times and more. *The paper's rule*, which gives the verdict, is the
paper's algorithm as it was meant: its misprints and gaps are filled as
[interpretations.md](interpretations.md) says, and values that it does not print were chosen on
seeds from 100 on, which are not reported. *Our interpretation* has the extensions that
the setting names, or the variant's defaults. *As printed* follows the paper to the letter. "No" is
as good an answer as "yes".

{overview}
"""


def write_report(folder: Path, experiment: Experiment, report: Report, size: Size) -> None:
    """Write data, figure and verdict of `experiment` into `folder`.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    make_folder(folder)
    write_text(folder / DATA, report.data.to_csv())
    for kind in ("svg", "png"):
        save(report.figure, folder / f"{FIGURE}.{kind}")
    facts = {
        "name": experiment.name,
        "title": experiment.title,
        "seeds": list(size.seeds),
        "versions": versions(),
    }
    write_json(folder / f"{VERDICT}.json", {**facts, **report.verdict.to_json()})
    write_text(folder / f"{VERDICT}.md", _section(experiment, report, size))


def write_document(
    folder: Path, results: Path, papers: Mapping[str, Sequence[Experiment]], command: str
) -> Path:
    """Join the verdicts that are in `results` to a page in `folder`, with the figures beside it.

    Parameters
    ----------
    folder, results : Path
        Folders of the page, and of the experiments' own folders.
    papers : mapping of str to sequence of Experiment
        The experiments by paper, whose name heads their sections.
    command : str
        Makes everything on the page.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    pictures = make_folder(folder / _PICTURES)
    overview, sections = [], []
    for paper, experiments in papers.items():
        made = [e for e in experiments if (results / e.name / f"{VERDICT}.md").exists()]
        if made:
            overview.append("\n".join([f"**{paper}**", "", *_overview(results, made)]))
            sections.append(f"## {paper}\n")
            sections += [_shown_section(results, pictures, experiment) for experiment in made]
    head = _HEAD.format(command=command, overview="\n\n".join(overview))
    write_text(folder / "reproduction.md", "\n".join([head, *sections]))
    return folder / "reproduction.md"


def _overview(results: Path, made: Sequence[Experiment]) -> list[str]:
    """Make a table of the experiments with their verdicts."""
    lines = [
        f"| figure | what | {PAPER} | {OURS} | {PRINTED} | seeds |",
        "|---|---|---|---|---|---|",
    ]
    for experiment in made:
        verdict = json.loads((results / experiment.name / f"{VERDICT}.json").read_text("utf-8"))
        lines.append(
            f"| [`{experiment.name}`](#{experiment.name}) | {experiment.title} | "
            f"**{verdict['holds']}** | "
            + " | ".join(verdict["under"][name] or "–" for name in (OURS, PRINTED))
            + f" | {_seeds(verdict['seeds'])} |"
        )
    return lines


def _seeds(seeds: Sequence[int]) -> str:
    return f"{seeds[0]} to {seeds[-1]}" if len(seeds) > 1 else f"{seeds[0]}"


def _shown_section(results: Path, pictures: Path, experiment: Experiment) -> str:
    """Take over an experiment's own page, one heading lower, and its figure."""
    text = (results / experiment.name / f"{VERDICT}.md").read_text(encoding="utf-8")
    picture = _copy_smallest(results / experiment.name, pictures, experiment.name)
    return "#" + text.replace(f"({FIGURE}.png)", f"({_PICTURES}/{picture})")


def _section(experiment: Experiment, report: Report, size: Size) -> str:
    tables = [f"{title}\n\n{table.to_markdown()}" for title, table in report.tables.items()]
    parts = [
        f"## {experiment.name}",
        f"{experiment.title}. Made by `{_command(experiment, size)}`.",
        f"![{experiment.title}]({FIGURE}.png)",
        *tables,
        report.verdict.to_markdown(),
    ]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def _command(experiment: Experiment, size: Size) -> str:
    words = ["python -m reproduction", experiment.name]
    words += ["--quick"] if size.quick else []
    usual = size.of(SEEDS, QUICK_SEEDS)
    words += [] if len(size.seeds) == usual else [f"--seeds {len(size.seeds)}"]
    words += [f"--first-seed {size.seeds.start}"] if size.seeds.start else []
    return " ".join(words)


def _copy_smallest(source: Path, target: Path, name: str) -> str:
    """Copy the figure in the format that takes less room, and return the copy's name."""
    figures = [source / f"{FIGURE}.{kind}" for kind in ("svg", "png")]
    smallest = min(figures, key=lambda path: path.stat().st_size)
    with output_errors(target):
        for kind in ("svg", "png"):
            (target / f"{name}.{kind}").unlink(missing_ok=True)
        shutil.copyfile(smallest, target / f"{name}{smallest.suffix}")
    return f"{name}{smallest.suffix}"
