# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Systems of the second paper's experiments: four filters, their interpretations, six cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from reproduction.experiment import (
    BASIC_RIVALS,
    OUR_INTERPRETATION,
    PAPER_RULE,
    PRINTED_RULE,
    Results,
    Size,
)
from reproduction.runs.cells import PATH_COLUMNS, RunCell, SceneChoice, System, scores
from reproduction.scenes.paper_scenes import CASE_SCENES
from vehicle_pf_tracker.evaluation.scores import Scores
from vehicle_pf_tracker.parameters.table import Value
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import MfpfParameters

FEATURE_NAMES: Mapping[str, str] = MappingProxyType(
    {"color": "RGB", "edge": "Edge", "texture": "Texture"}
)
"""The names that `~/mode` uses, and the paper's, in the order of its tables."""
COLOR, EDGE, TEXTURE = (System.of(label, f"sfpf_{name}") for name, label in FEATURE_NAMES.items())
MFPF = System.of("MFPF", "mfpf")
SINGLE_FEATURES = (COLOR, EDGE, TEXTURE)
FOUR_SYSTEMS = (*SINGLE_FEATURES, MFPF)
"""The four filters in the order of the paper's tables."""

DEFAULTS = "defaults"
"""Interpretation that leaves every parameter at its default."""
_STEADY: Mapping[str, Value] = MappingProxyType(
    {
        "dispersion.radius": 4.0,
        "dispersion.start": 10.0,
        "likelihood.sigma_v": 0.15,
        "velocity_window": 25,
        "confidence.best_share": 0.02,
        "confidence.threshold": 0.8,
        "reference_weight": 0.8,
    }
)
"""Settings for a still camera and vehicles at constant speed, as in all six cases."""
_RULE: Mapping[str, Value] = MappingProxyType({"dispersion.noise": "gaussian"})
_RULE_OF_ALL: Mapping[str, Value] = MappingProxyType({"update_unused": True})
"""Settings that the paper prints and our interpretation has otherwise: `_RULE` of all filters, the
other of MFPF alone, which has the parameter."""
_EDGES: Mapping[str, Value] = MappingProxyType({"edges.threshold": 0.2, "edges.floor": 60.0})
"""Edge points of the filters that have the edge feature, chosen with `_STEADY`."""
INTERPRETATIONS: Mapping[str, Mapping[str, Value]] = MappingProxyType(
    {
        PAPER_RULE: {**_STEADY, **_RULE},
        OUR_INTERPRETATION: _STEADY,
        DEFAULTS: {},
        PRINTED_RULE: {"as_printed": True, "dispersion.radius": 4.0},
    }
)
"""Settings of every filter by interpretation; the paper prints no radius, so it gets ours."""

_SHARP: Mapping[str, Value] = MappingProxyType({"likelihood.sigma_v": 0.1})
"""A sharper likelihood, which a filter with one feature needs where three multiply theirs."""
_OWN: Mapping[str, Mapping[str, Mapping[str, Value]]] = MappingProxyType(
    {
        PAPER_RULE: {"sfpf_edge": _SHARP, "sfpf_texture": _SHARP},
        BASIC_RIVALS: {"sfpf_texture": {"reference_weight": 0.6}},
    }
)
"""Values that serve a single-feature filter better than those chosen for MFPF. Tried were, one
change each on the six cases with seed 100: radius 8, sigma_v 0.1, velocity_window 10, and
threshold 0.7 or reference_weight 0.6 and 0.95. RMS of the edge filter 73 to 48 px, of the texture
filter 48 to 39 px, of the basic texture filter 79 to 70 px; the shared values are the others' best.
"""
RIVALRIES: Mapping[str, Mapping[str, Value]] = MappingProxyType(
    {
        PAPER_RULE: INTERPRETATIONS[PAPER_RULE],
        BASIC_RIVALS: {**_STEADY, **_RULE},
        **{name: INTERPRETATIONS[name] for name in (OUR_INTERPRETATION, DEFAULTS, PRINTED_RULE)},
    }
)
"""Settings of every filter in comparisons of MFPF with the single-feature filters: those above, and
those of basic rivals."""

CASES = tuple(f"case{number}" for number in range(1, 7))
QUICK_CASES = "case2", "case6"
"""Cases of a quick run: one with a partial occlusion, one with a total one."""
FULLY_HIDDEN = "case4", "case5", "case6"
"""Cases in which the vehicle disappears."""
WITHOUT_HIDING = "case1", "case2", "case3"
"""Cases in which some of the vehicle is always visible."""

LAST_FRAMES = 20
"""Last frames in which a run must stay close to count as having tracked to the end."""


def read_label(label: str, interpretation: str) -> str:
    """Name a filter, or a feature, under `interpretation`; the paper's rule goes without saying."""
    return label if interpretation == PAPER_RULE else f"{label}, {interpretation}"


def read_as(system: System, interpretation: str) -> System:
    """Give the settings of `interpretation` to a filter, under a name of its own."""
    if interpretation == BASIC_RIVALS and system.variant == "mfpf":
        return read_as(system, PAPER_RULE)
    settings = dict(RIVALRIES[interpretation])
    if interpretation in (PAPER_RULE, BASIC_RIVALS, OUR_INTERPRETATION) and system.variant in (
        "mfpf",
        "sfpf_edge",
    ):
        settings |= _EDGES
    if interpretation == BASIC_RIVALS:
        settings |= {"extended": False}
    settings |= _OWN.get(interpretation, {}).get(system.variant, {})
    if interpretation == PAPER_RULE and system.variant == "mfpf":
        settings |= _RULE_OF_ALL
    return replace(system.but(settings), label=read_label(system.label, interpretation))


def cases(size: Size) -> tuple[str, ...]:
    """Name the cases that run."""
    return size.of(CASES, QUICK_CASES)


def cell(case: str, system: System, seed: int, interpretation: str = PAPER_RULE) -> RunCell:
    """Make the cell of a filter on a case; the seed draws the scene, too."""
    own = [name for name in FEATURE_NAMES if system.variant in ("mfpf", f"sfpf_{name}")]
    record = (
        *PATH_COLUMNS,
        "regime",
        *(f"{value}_{name}" for value in ("as", "used") for name in own),
    )
    return RunCell(SceneChoice.of(case).seeded(seed), read_as(system, interpretation), seed, record)


def cells(size: Size) -> list[RunCell]:
    """Run the four filters on every case, under every interpretation, with every seed."""
    all_cells = [
        cell(case, system, seed, interpretation)
        for case in cases(size)
        for interpretation in RIVALRIES
        for system in FOUR_SYSTEMS
        for seed in size.seeds
    ]
    return list(dict.fromkeys(all_cells))


def run_scores(
    results: Results, case: str, system: System, seed: int, interpretation: str = PAPER_RULE
) -> Scores:
    """Score one run against the truth again."""
    run = cell(case, system, seed, interpretation)
    return scores(run, results[run])


def trace(
    results: Results, case: str, system: System, seed: int, interpretation: str = PAPER_RULE
) -> Mapping[str, list[Any]]:
    """Give what was recorded of one run."""
    recorded: Mapping[str, list[Any]] = results[cell(case, system, seed, interpretation)]["trace"]
    return recorded


def metric(
    results: Results, case: str, system: System, seed: int, interpretation: str, name: str
) -> float:
    """Give one metric of one run."""
    return float(results[cell(case, system, seed, interpretation)]["metrics"][name])


def per_seed(
    results: Results, size: Size, case: str, system: System, interpretation: str, name: str
) -> list[float]:
    """Give one metric of a filter on a case, for each seed."""
    return [metric(results, case, system, seed, interpretation, name) for seed in size.seeds]


def threshold(interpretation: str) -> float:
    """Return the share of its first average similarity below which a feature drops out."""
    settings: MfpfParameters = read_as(MFPF, interpretation).parameters(0).effective()
    return settings.confidence.threshold


def occlusion_text(case: str) -> str:
    """Return the content of a case's scene, such as what occludes the vehicle."""
    return CASE_SCENES[case].what


_VALUES = ", ".join(f"`{name}` {value:g}" for name, value in {**_STEADY, **_EDGES}.items())
INTERPRETATIONS_NOTE = (
    "The paper's rule has the Gaussian noise of equation 5, and lets all references follow as step "
    "2 does. Our interpretation draws noise from a disc, and keeps the references of features "
    "that have dropped out. Both give all filters and cases one set of values where the paper has "
    f"none or its own fails: {_VALUES}. They suit a camera that stands still and vehicles that "
    "keep their speed, and were chosen for MFPF's mean RMS with seeds above 99, out of 130 "
    "settings. Only `dispersion.start` was not: with the doubled radius in the first step alone, a "
    "filter that knows no speed yet falls 7 to 17 px behind within ten frames. Ten steps take "
    "RGB's RMS in case 1 from 5.7 to 4.3 px (seeds 100 to 102). Defaults are those of `mfpf` and "
    "`sfpf_*`, which serve cameras that move. As printed follows the paper to the letter; it "
    "prints no radius, so it gets ours. Two readings of the single-feature filters are open "
    "(interpretation 32), and MFPF is judged beside both: with all that section IV adds, and, "
    "named basic, as section III has them. In both, a filter has values of its own where they "
    "serve it better (by the paper's rule `likelihood.sigma_v` 0.1 for edge and texture, basic "
    "`reference_weight` 0.6 for texture; seed 100). As printed they are basic."
)


def setting(size: Size) -> str:
    """Describe the runs."""
    return (
        "Scenes `case1` to `case6` are counterparts of the paper's six cases, made before any "
        f"tracker ran on them. Seeds {size.seeds.start} to {size.seeds.stop - 1}: each renders a "
        "new scene (colour of the vehicle, traffic, ground, noise) and seeds the filters. "
        + INTERPRETATIONS_NOTE
    )
