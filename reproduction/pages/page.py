# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Page of all experiments in a folder of documents, with its figures and its data beside it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from reproduction.pages.output import FIGURE, VERDICT
from reproduction.pages.page_text import DATA, PICTURES, Verdict, page_text
from reproduction.paper import Paper
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.results.output_files import make_folder, write_json, write_text

PAGE = "reproduction.md"
"""File of the page."""
SAME_CODE = "All were made by the same code."
"""Versions of the code that the runs are of, where `write_page` has checked them."""


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
    verdicts = {
        experiment.name: json.loads(path.read_text(encoding="utf-8"))
        for paper in papers
        for experiment in paper.experiments
        if (path := results / experiment.name / f"{VERDICT}.json").exists()
    }
    _check_same_code(results, verdicts)
    folder_of_pictures = make_folder(folder / PICTURES)
    pictures = {name: _copy_smallest(results / name, folder_of_pictures, name) for name in verdicts}
    page = folder / PAGE
    write_text(page, page_text(papers, verdicts, pictures, command, SAME_CODE))
    data = {"command": command, "provenance": SAME_CODE, "verdicts": verdicts, "pictures": pictures}
    write_json(folder / DATA, data)
    return page


def page_of_data(path: Path, papers: Sequence[Paper]) -> str:
    """Write a page again from its data, as after a change of how it is written."""
    data = json.loads(path.read_text(encoding="utf-8"))
    return page_text(papers, **data)


def _check_same_code(results: Path, verdicts: Mapping[str, Verdict]) -> None:
    """Refuse a page whose rows could contradict each other, as they are of several versions."""
    by_code: dict[str, list[str]] = {}
    for name, verdict in verdicts.items():
        by_code.setdefault(verdict["code"], []).append(name)
    if len(by_code) > 1:
        *_, rarest = sorted(by_code.values(), key=len, reverse=True)
        raise InputError(
            f"{', '.join(rarest)} in {results} were made by other code than the rest: run "
            "everything again, or name another folder with --output"
        )


def _copy_smallest(source: Path, target: Path, name: str) -> str:
    """Copy the figure in the format that takes less room, and return the copy's name."""
    figures = [source / f"{FIGURE}.{kind}" for kind in ("svg", "png")]
    smallest = min(figures, key=lambda path: path.stat().st_size)
    with output_errors(target):
        for kind in ("svg", "png"):
            (target / f"{name}.{kind}").unlink(missing_ok=True)
        shutil.copyfile(smallest, target / f"{name}{smallest.suffix}")
    return f"{name}{smallest.suffix}"
