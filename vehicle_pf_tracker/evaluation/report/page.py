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

"""`report.html`: one file that needs nothing else, made from the template beside it."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source, SystemEntry
from vehicle_pf_tracker.evaluation.plots import STYLES
from vehicle_pf_tracker.evaluation.report import filmstrip, page_tables
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates, findings, power
from vehicle_pf_tracker.evaluation.report.columns import RANKED, counted, p_value_text
from vehicle_pf_tracker.evaluation.report.figures import (
    Panel,
    SvgMaker,
    curve_panels,
    error_panels,
    main_panel,
)
from vehicle_pf_tracker.evaluation.report.filmstrip import Still
from vehicle_pf_tracker.evaluation.report.page_tables import speed_note, speed_table
from vehicle_pf_tracker.evaluation.report.robustness import robustness_sections
from vehicle_pf_tracker.evaluation.report.scored_runs import (
    FailedCell,
    ScoredEvaluation,
    ScoredRun,
    typical,
)
from vehicle_pf_tracker.evaluation.report.traffic import stored_sections
from vehicle_pf_tracker.evaluation.traffic.comparison_report import RULES


@dataclass(frozen=True, slots=True)
class RecordingSection:
    """A recording's section of the page."""

    name: str
    facts: str
    table: page_tables.PageTable
    occlusions: page_tables.PageTable | None
    panels: Sequence[Panel]
    strips: Sequence[tuple[str, Sequence[Still]]]
    note: str


@dataclass(frozen=True, slots=True)
class FailedGroup:
    """Cells that failed for the same reason."""

    system: str
    cells: str
    reason: str


def make_page(evaluation: ScoredEvaluation, aggregates: Aggregates, *, images: bool = True) -> str:
    """Return the text of the page.

    Parameters
    ----------
    evaluation, aggregates : ScoredEvaluation, Aggregates
        The evaluation to show, and its summaries.
    images : bool
        True to show stills of the recordings.
    """
    environment = Environment(
        loader=PackageLoader("vehicle_pf_tracker.evaluation.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    slots = styled(aggregates)
    maker = SvgMaker()
    plan = evaluation.folder.plan
    return environment.get_template("report.html").render(
        title=title(evaluation),
        facts=_facts(evaluation),
        findings=findings(evaluation, aggregates),
        slots=slots,
        overall=page_tables.overall_table(aggregates, slots),
        main=main_panel(aggregates, maker),
        ranks=page_tables.ranks_table(aggregates, slots),
        rank_notes=list(_rank_notes(aggregates)),
        pairs=page_tables.pairs_table(aggregates, slots),
        power=power(aggregates),
        curves=curve_panels(evaluation, aggregates.order, slots, maker),
        recordings=[
            _section(evaluation, aggregates, entry, slots, maker, images)
            for entry in evaluation.recordings
        ],
        robustness=robustness_sections(evaluation.folder, aggregates.order, slots),
        traffic=stored_sections(evaluation.folder.path),
        traffic_about=RULES,
        speed=speed_table(evaluation.folder.timings(), aggregates.order, slots),
        speed_note=speed_note(evaluation.folder.timings()),
        systems=system_sections(evaluation.systems),
        seeds=", ".join(map(str, evaluation.folder.seeds)),
        versions=_words(plan.get("versions", {})),
        options=_words(
            {f"--{name.replace('_', '-')}": v for name, v in plan.get("options", {}).items()}
        ),
        sources=[(entry.name, entry.path, entry.topic, entry.digest)
                 for entry in evaluation.recordings],
        command=shlex.join(map(str, plan.get("command", []))),
        failed=_failed_groups(evaluation.failed),
    )  # fmt: skip


def title(evaluation: ScoredEvaluation) -> str:
    """Return the title of the report."""
    return f"Trackers compared: {evaluation.folder.path.resolve().name}"


def styled(aggregates: Aggregates) -> dict[str, int]:
    """Assign styles to the first systems."""
    return {label: slot for slot, label in enumerate(aggregates.order[: len(STYLES)])}


def _facts(evaluation: ScoredEvaluation) -> str:
    return " × ".join(
        (
            counted(len(evaluation.recordings), "recording"),
            counted(len(evaluation.systems), "system"),
            counted(len(evaluation.folder.seeds), "seed"),
        )
    )


def _rank_notes(aggregates: Aggregates) -> Iterator[str]:
    for column in RANKED:
        ranking = aggregates.rankings.get(column.key)
        if ranking is None:
            continue
        parts = [f"{column.label}: {counted(ranking.recordings, 'recording')}"]
        if ranking.friedman_p is not None:
            parts.append(f"Friedman p {p_value_text(ranking.friedman_p)}")
        if ranking.critical_difference is not None:
            parts.append(f"critical difference of mean ranks {ranking.critical_difference:.2f}")
        yield ", ".join(parts)


def _section(
    evaluation: ScoredEvaluation,
    aggregates: Aggregates,
    entry: Source,
    slots: Mapping[str, int],
    maker: SvgMaker,
    images: bool,
) -> RecordingSection:
    truths = evaluation.truths[entry.name]
    runs = {label: some for label in aggregates.order if (some := evaluation.of(entry.name, label))}
    strips, note = _strips(entry, truths, runs, slots) if images else ([], "")
    return RecordingSection(
        name=entry.name,
        facts=_recording_facts(entry, truths),
        table=page_tables.recording_table(aggregates, entry.name, slots),
        occlusions=page_tables.occlusions_table(runs, slots),
        panels=error_panels(runs, truths, maker),
        strips=strips,
        note=note,
    )


def _recording_facts(entry: Source, truths: Mapping[int, Truth]) -> str:
    kinds = Counter(truth.occlusion.name.lower() for truth in truths.values())
    parts = [counted(entry.frames, "frame"), f"{entry.width} × {entry.height} px"]
    parts += [f"{len(truths)} with truth"] if len(truths) != entry.frames else []
    parts += [f"{kinds['partial']} partly occluded"] if kinds["partial"] else []
    parts += [f"{kinds['total']} totally occluded"] if kinds["total"] else []
    return ", ".join(parts)


def _strips(
    entry: Source,
    truths: Mapping[int, Truth],
    runs: Mapping[str, Sequence[ScoredRun]],
    slots: Mapping[str, int],
) -> tuple[list[tuple[str, Sequence[Still]]], str]:
    """Take the stills, and say why there are none."""
    shown = {label: run for label, some in runs.items() if (run := typical(some)) is not None}
    strips = filmstrip.plan_strips(truths, shown, slots)
    try:
        taken = filmstrip.take_stills(entry, [shot for strip in strips for shot in strip.shots])
    except InputError as error:
        return [], f"There are no stills: {error}."
    shots = [(strip.title, filmstrip.stills_of(strip, taken)) for strip in strips]
    return [(title, stills) for title, stills in shots if stills], ""


def _failed_groups(failed: Sequence[FailedCell]) -> list[FailedGroup]:
    groups: dict[tuple[str, str], list[FailedCell]] = {}
    for cell in failed:
        groups.setdefault((cell.system, cell.reason), []).append(cell)
    return [
        FailedGroup(system, _cells(cells), reason) for (system, reason), cells in groups.items()
    ]


def _cells(cells: Sequence[FailedCell]) -> str:
    by_recording: dict[str, list[str]] = {}
    for cell in cells:
        by_recording.setdefault(cell.recording, []).append(str(cell.seed))
    return "; ".join(f"{name}: seed {', '.join(seeds)}" for name, seeds in by_recording.items())


def _words(values: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [(name, _word(value)) for name, value in values.items()]


def _word(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "–" if value is None else str(value)


@dataclass(frozen=True, slots=True)
class ParameterRow:
    """One parameter, and whether it was set rather than left at its default."""

    name: str
    value: str
    was_set: bool


@dataclass(frozen=True, slots=True)
class SystemSection:
    """A system's section of the page."""

    label: str
    kind: str
    parameter_set: str
    rows: tuple[ParameterRow, ...]


def system_sections(systems: tuple[SystemEntry, ...]) -> list[SystemSection]:
    """Describe all systems."""
    sections = []
    for system in systems:
        values = flat(system.parameters)
        were_set = flat(system.overrides)
        rows = [ParameterRow(name, _text(values.get(name, value)), was_set=True)
                for name, value in were_set.items()]  # fmt: skip
        rows += [ParameterRow(name, _text(value), was_set=False)
                 for name, value in values.items() if name not in were_set]  # fmt: skip
        section = SystemSection(system.label, system.kind, system.parameter_set, tuple(rows))
        sections.append(section)
    return sections


def _text(value: Any) -> str:
    """Return a value as it stands in a parameter file."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested values by their dotted names."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{name}.")
        else:
            found[prefix + name] = value
    return found
