# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every claim of every experiment can be confirmed, confirmed in part, and refuted."""

import ast
import importlib
from pathlib import Path

import numpy as np
import pytest

from reproduction import experiment
from reproduction.apf import systems as apf_systems
from reproduction.apf import table2 as apf_table2
from reproduction.apf.published import published_ratio
from reproduction.experiment import Size

FOLDER = Path(experiment.__file__).parent
MODULES = [path for path in FOLDER.rglob("*.py") if "test" not in path.relative_to(FOLDER).parts]
NAME = "the paper's rule"
ONE = apf_systems.COMPARISONS[0]
RIVALS = ONE.rival_labels


def grid(best):
    """RMSE by speed, sigma and seed of the quick grid (4, 12; 2, 6, 12): least at `best`."""
    return np.array([[[1.0 if s == b else 9.0] * 2 for s in (2, 6, 12)] for b in best])


def flat(*rows):
    return np.array([[[value] * 2 for value in row] for row in rows])


class Runs:
    """Runs that `apf-fig3` judges: three widths with one run each, and a value for each of them."""

    def __init__(self, values):
        self.widths, self.values, self.seeds = (0, 60, 120), values, range(1)

    def by_width(self, interpretation, what):
        return self.values

    def of(self, interpretation, what):
        return [what(width, value) for width, value in zip(self.widths, self.values, strict=False)]

    def end_error(self, width, run):
        return run


def ended(regular):
    """A run whose last ten frames have so many regular ones."""
    return {"trace": {"regime": ["regular"] * regular + ["occlusion"] * (10 - regular)}}


def traced(pi, regime):
    """A run of `apf-fig4` with similarities and regimes of its 115 frames."""
    pis, regimes = [1.0] * 115, ["regular"] * 115
    pis[0] = None
    for index, value in pi.items():
        pis[index] = value
    for index in regime:
        regimes[index] = "occlusion"
    return {"trace": {"pi": pis, "pi_up": list(pis), "regime": regimes}}


NARROW, WIDE = (importlib.import_module("reproduction.apf.fig4")._span(w) for w in (1, 30))
AT_1, AT_30 = NARROW.start + 4, WIDE.start + 4
UNDETECTED = traced({}, ())
DETECTED = traced({AT_30: 0.2}, (AT_30, AT_30 + 1))
BEFORE = traced({AT_30: 0.2}, range(5, 115))


def table2(own, others):
    """RMSE on the quick videos (06 total, 15 partial, 19 none) by tracker, two seeds each."""
    videos = ("video06", "video15", "video19")
    return {
        video: {
            **{label: [other] * 2 for label in RIVALS},
            ONE.apf.label: [mine] * 2 if np.isscalar(mine) else list(mine),
        }
        for video, mine, other in zip(videos, own, others, strict=True)
    }


def unoccluded(*ratios):
    pairs = zip(("video19", "video20"), ratios, strict=True)
    return {
        video: {
            **{label: [10.0] for label in RIVALS},
            ONE.apf.label: [10.0 * ratio * published_ratio(video)],
        }
        for video, ratio in pairs
    }


def recovered(own, others):
    return {ONE.apf.label: own, **dict.fromkeys(RIVALS, others)}


def times(**ratios):
    return {label: [ratios.get(label, 1.0)] for label in ("PF", "SAPF", "HPFMS", "PFCL", "MS")}


def rms(*cases):
    """RMS by case of RGB, Edge, Texture and MFPF, the same with ten seeds unless listed."""
    labels = ("RGB", "Edge", "Texture", "MFPF")
    return {
        f"case{n}": {
            label: list(value) if np.iterable(value) else [value] * 10
            for label, value in zip(labels, case, strict=True)
        }
        for n, case in enumerate(cases, start=1)
    }


def hidden_rms(*cases):
    return {f"case{n}": of for n, of in zip((4, 5, 6), rms(*cases).values(), strict=False)}


def ends(*cases):
    """Runs that end close, of ten, by case (1, 4) of the four filters."""
    found = rms(*[[[n < value for n in range(10)] for value in case] for case in cases])
    return dict(zip(("case1", "case4"), found.values(), strict=True))


def phases(conventional, adaptive):
    """RMSE (or counts) of both filters by phase, the same in all unless a list of four."""
    names = ("before", "partial", "full", "after")

    def of(values):
        values = [values] * 4 if np.isscalar(values) else values
        rows = {n: v if np.iterable(v) else [v] * 10 for n, v in zip(names, values, strict=True)}
        return {**rows, "all": rows["after"]}

    return {"conventional": of(conventional), "adaptive": of(adaptive)}


def means(conventional, adaptive):
    return {
        variant: {name: float(of[0]) for name, of in found.items() if name != "all"}
        for variant, found in phases(conventional, adaptive).items()
    }


def distances(shadow, partial, full=(0.9, 0.9, 0.9)):
    """Distances of colour, edge and texture."""
    return {
        name: {f: [v] for f, v in zip(("color", "edge", "texture"), values, strict=True)}
        for name, values in (("shadow", shadow), ("partial", partial), ("full", full))
    }


def features(color, edge, texture):
    return {"color": [color], "edge": [edge], "texture": [texture]}


def textures(glcm, lbp, haralick):
    return {
        name: [[joint], [alone]]
        for name, (joint, alone) in {"glcm": glcm, "lbp": lbp, "haralick": haralick}.items()
    }


QUICK = Size(range(2), quick=True)
UNIFORM = np.full(10, 0.1)
EVEN, BIASED, WRONG = np.full(10, 1000.0), np.full(10, 100000.0), np.full(10, 1000.0)
BIASED[:2] += (2000.0, -2000.0)
WRONG[:2] += (300.0, -300.0)
UP = [1.0, 2.0, 3.0]

YES_PARTLY_NO = {
    "apf.fig1._least": (
        (NAME, grid((2, 6)), QUICK),
        (NAME, flat((1.2, 9, 1), (9, 1.2, 1)), QUICK),
        (NAME, grid((6, 12)), QUICK),
    ),
    "apf.fig1._above": (
        (NAME, grid((2, 6)), QUICK),
        (NAME, flat((1, 1, 20), (1, 1, 1)), QUICK),
        (NAME, flat((20, 20, 20), (20, 20, 20)), QUICK),
    ),
    "apf.fig2._hides": (([1.0, 0.05],), ([1.0, 0.3],), ([1.0, 0.6],)),
    "apf.fig3._tracked": (
        (Runs([1.0, 2.0, 3.0]), NAME), (Runs([1.0, 2.0, 30.0]), NAME),
        (Runs([1.0, 20.0, 30.0]), NAME),
    ),
    "apf.fig3._longer": (
        (Runs(UP), NAME), (Runs([1.0, 3.0, 2.0]), NAME), (Runs([3.0, 2.0, 1.0]), NAME)
    ),
    "apf.fig3._deeper": (
        (Runs([3.0, 2.0, 1.0]), NAME), (Runs([3.0, 1.0, 2.0]), NAME), (Runs(UP), NAME)
    ),
    "apf.fig3._resumed": tuple(
        (Runs([ended(n) for n in regular]), NAME) for regular in ([5, 9], [5, 0], [4, 0])
    ),
    "apf.fig4._ignored": (
        (NAME, [UNDETECTED] * 2), (NAME, [traced({90: 0.7}, (91,))] * 2),
        (NAME, [traced({AT_1: 0.7}, (AT_1,))] * 2),
    ),
    "apf.fig4._detected": (
        (NAME, [DETECTED] * 2), (NAME, [DETECTED, BEFORE]), (NAME, [BEFORE] * 2)
    ),
    "apf.fig5._followed": tuple(
        (NAME, hits, [1.0]) for hits in ([True] * 4, [True] + [False] * 3, [False] * 4)
    ),
    "apf.fig5._by_share": tuple(
        (NAME, shares, "{}") for shares in ([0.9, 0.8], [0.9, 0.1], [0.4, 0.1])
    ),
    "apf.fig6._finding": tuple(
        (NAME, own, {"PF": ([2.0], [2.0])})
        for own in (([1.0], [1.0]), ([3.0], [1.0]), ([3.0], [3.0]))
    ),
    "apf.fig7._overcomes": (
        (NAME, [True] * 4), (NAME, [True] + [False] * 3), (NAME, [False] * 4)
    ),
    "apf.fig7._others_lost": (
        ({"PF": [False] * 4},), ({"PF": [True, False]},), ({"PF": [True] * 4},)
    ),
    "apf.table1._all_fit": (([True] * 4,), ([True, False],), ([True] + [False] * 3,)),
    "apf.table2._first": tuple(
        (table2(own, (20.0,) * 3), ["video06"], ONE, at_most)
        for own, at_most in (((9.0,) * 3, 0.5), (((19.0, 90.0), 1.0, 1.0), 1.0), ((21.0,) * 3, 1.0))
    ),
    "apf.table2._everywhere": tuple(
        (table2(own, (20.0,) * 3), ONE)
        for own in ((9.0, 9.0, 90.0), (9.0, 21.0, 9.0), (21.0, 21.0, 9.0))
    ),
    "apf.table2._resumes": (
        (recovered([True] * 10, [False] * 10), ONE),
        (recovered([True] * 5 + [False] * 5, [False] * 10), ONE),
        (recovered([False] * 10, [True] * 10), ONE),
    ),
    "apf.table2._unoccluded": (
        (unoccluded(1.0, 1.2), ONE), (unoccluded(1.0, 1.3), ONE), (unoccluded(0.7, 1.3), ONE)
    ),
    "apf.table2._alike": tuple(
        ({"PF": a, "APF": b, "MS": b},) for a, b in ((0.7, 0.8), (0.1, 0.4), (0.9, 0.3))
    ),
    "apf.timing._no_more": (
        (times(),), (times(PF=0.9),), (times(PF=0.9, SAPF=0.9, HPFMS=0.9, PFCL=0.9),)
    ),
    "apf.timing._about_the_same": (
        (times(),), (times(PF=1.2),), (times(PF=1.2, SAPF=1.2, HPFMS=1.2, PFCL=0.5),)
    ),
    "apf.timing._least": ((times(MS=0.5),), (times(MS=0.8, PF=0.7),), (times(MS=1.1),)),
    "mfpf.errors._steadiest": tuple(
        (NAME, dict(zip(("RGB", "Edge", "Texture", "MFPF"), spreads, strict=True)))
        for spreads in ((2, 9, 3, 1), (9, 2, 3, 1), (1, 9, 3, 2))
    ),
    "mfpf.errors._in_parts": (
        (NAME, {"case1": (0.5, True), "case2": (0.9, True)}),
        (NAME, {"case1": (0.5, True), "case2": (0.1, False)}),
        (NAME, {"case1": (1.0, True), "case2": (0.1, False)}),
    ),
    "mfpf.fig2._finding": (
        ("multinomial", UNIFORM, EVEN, 10_000), ("multinomial", UNIFORM, BIASED, 1_000_000),
        ("multinomial", UNIFORM, WRONG, 10_000),
    ),
    "mfpf.frames._finding": (
        ({"case1": ([0], [9]), "case4": ([70], [9])},),
        ({"case1": ([0], [9]), "case4": ([20], [9])},),
        ({"case1": ([3], [9]), "case4": ([20], [9])},),
    ),
    "mfpf.histograms._order": (
        (NAME, distances((3, 1, 2), (3, 1, 2))), (NAME, distances((2, 1, 3), (1, 2, 3))),
        (NAME, distances((1, 2, 3), (1, 2, 3))),
    ),
    "mfpf.histograms._empty": tuple(
        (NAME, distances((1, 1, 1), (1, 1, 1), full))
        for full in ((0.6, 0.7, 0.8), (0.6, 0.5, 0.5), (0.5, 0.5, 0.5))
    ),
    "mfpf.similarities._stays": tuple(
        (NAME, {"case2": features(1.0, 1.0, 1.0), "case3": features(least, 1.0, 1.0)})
        for least in (0.95, 0.5, 0.4)
    ),
    "mfpf.similarities._lowest": (
        (NAME, features(0.9, 0.5, 0.1)), (NAME, features(0.5, 0.9, 0.1)),
        (NAME, features(0.1, 0.9, 0.5)),
    ),
    "mfpf.similarities._excluded": tuple(
        (NAME, [(0.5, 0.0, 0.0)] * hits + [(0.5, 0.1, 0.0)] * (10 - hits)) for hits in (8, 2, 1)
    ),
    "mfpf.similarities._acceptable": (
        (NAME, [(True, True)] * 8 + [(False, False)] * 2), (NAME, [(True, False)] * 10),
        (NAME, [(False, False)] * 10),
    ),
    "mfpf.similarities._first_back": (
        (NAME, [["edge"]] * 8 + [["color"]] * 2), (NAME, [["edge"]] * 5 + [["color"]] * 4),
        (NAME, [["color"]] * 6 + [["edge"]] * 4),
    ),
    "mfpf.table1._least": (
        (NAME, rms((2, 3, 4, 1), (2, 3, 4, 2))), (NAME, rms((2, 3, 4, 1), (2, 3, 4, 5))),
        (NAME, rms((2, 3, 4, 5), (2, 3, 4, 5))),
    ),
    "mfpf.table1._saving": (
        (NAME, rms((10, 20, 30, 9), (20, 10, 30, 8))),
        (NAME, rms((10, 20, 30, 9), (10, 20, 30, 9.5))),
        (NAME, rms((10, 20, 30, 9.5), (10, 20, 30, 11))),
    ),
    "mfpf.table1._no_single": (
        (NAME, rms((1, 2, 3, 9), (2, 1, 3, 9), (3, 2, 1, 9))),
        (NAME, rms((1, 2, 3, 9), (2, 1, 3, 9), (2, 1, 3, 9))),
        (NAME, rms((1, 2, 3, 9), (1, 2, 3, 9), (1, 2, 3, 9))),
    ),
    "mfpf.table1._over_all": tuple(
        (NAME, rms((9, 9, 9, own)), rms((5, 9, 9, 9)))
        for own in (4, (6,) * 7 + (1,) * 3, (6,) * 10)
    ),
    # As printed no filter follows any vehicle: 0 runs are no more than the rivals' 0.
    "mfpf.table1._to_the_end": (
        (NAME, ends((0, 0, 0, 8), (3, 2, 1, 3))), (NAME, ends((0, 0, 0, 7), (3, 2, 1, 3))),
        (NAME, ends((0, 0, 0, 0), (0, 0, 0, 0))),
    ),
    "mfpf.table2._open": (
        (NAME, rms((88, 97, 95, 100), (99, 99, 99, 100))),
        (NAME, rms((70, 97, 95, 100), (99, 99, 99, 90))),
        (NAME, rms((70, 97, 95, 90), (99, 99, 99, 90))),
    ),
    "mfpf.table2._less": (
        (NAME, hidden_rms((19, 69, 15, 73), (57, 76, 62, 86))),
        (NAME, hidden_rms((19, 69, 15, 73), (57, 76, 62, 70))),
        (NAME, hidden_rms((19, 69, 15, 60), (57, 76, 62, 70))),
    ),
    "mfpf.table2._predicts": tuple(
        (NAME, {"case4": [first], "case5": [second]})
        for first, second in ((80, 99), (20, 0), (19, 0))
    ),
    "mfpf.table3._first": (
        (NAME, rms((1, 2, 3, 4), (1, 2, 3, 4), (9, 9, 9, 4))),
        (NAME, rms((1, 2, 3, 4), (9, 9, 9, 4), (9, 9, 9, 4))),
        (NAME, rms((9, 9, 9, 4), (9, 9, 9, 4), (9, 9, 9, 4))),
    ),
    "mfpf.table3._over_all": tuple(
        (NAME, rms((50, 5, 5, own))) for own in (60, (49,) * 7 + (99,) * 3, 49)
    ),
    "mfpf.textures._finding": (
        (textures((1, 1), (2, 2), (3, 3)),), (textures((1, 2), (2, 1), (3, 3)),),
        (textures((2, 2), (1, 1), (3, 3)),),
    ),
    "mfpf.timing._tripled": (([2.9],), ([1.5],), ([1.1],)),
    "resampling.cost._no_more_time": (
        (NAME, [0.5, 1.0]), (NAME, [0.5, 0.5, 1.1]), (NAME, [1.1, 1.2])
    ),
    "resampling.fig4._both_low": tuple(
        (NAME, phases(*pair), "before") for pair in ((5, 5), (50, 5), (50, 50))
    ),
    "resampling.fig4._alike": (
        (NAME, phases(5, 6)), (NAME, phases(50, 60)), (NAME, phases(5, 9))
    ),
    "resampling.fig4._worse": tuple(
        (NAME, phases(*pair), "full") for pair in ((15, 10), (14, 10), (12, 10))
    ),
    "resampling.fig4._lost": (
        (NAME, phases(50, 5)),
        (NAME, phases([5, 5, 5, [50] * 9 + [5]], [5, 5, 5, [50] * 5 + [5] * 5])),
        (NAME, phases(5, 5)),
    ),
    "resampling.fig4._no_worse": (
        (NAME, phases(10, 10.5)), (NAME, phases(10, 12)), (NAME, phases(10, 13))
    ),
    "resampling.fig5._fewer": (
        (NAME, means(20, 1), means(200, 10)), (NAME, means(20, 1), means(200, 210)),
        (NAME, means(20, 21), means(200, 210)),
    ),
    "resampling.fig5._endless": (
        (NAME, means([5, 9, 20, 19], 1)), (NAME, means([5, 9, 20, 3], 1)),
        (NAME, means([5, 9, 9, 9], 1)),
    ),
    "resampling.fig5._few": (
        (NAME, means(20, 5)), (NAME, means(20, [5, 6, 6, 6])), (NAME, means(20, 6))
    ),
    "resampling.fig5._rises": tuple(
        (NAME, {"conventional": (100.0, a), "adaptive": (10.0, b)})
        for a, b in ((111.0, 11.1), (111.0, 9.0), (109.0, 10.0))
    ),
    "resampling.fig5._saving": (
        (NAME, [(20, 100), (10, 100)]), (NAME, [(21, 100), (10, 100)]), (NAME, [(50, 100)])
    ),
    "resampling.frames._on_it": tuple(
        (NAME, hits, 10) for hits in ([8, 8, 8, 8], [8, 8, 3, 8], [8, 7, 8, 8])
    ),
    "resampling.frames._stuck": tuple(
        (NAME, hits, 10) for hits in ([8, 8, 3, 2], [8, 8, 3, 3], [7, 8, 3, 3])
    ),
}  # fmt: skip
"""Arguments for each judge under which it says yes, partly and no."""


def judge(name):
    module, function = name.rsplit(".", 1)
    return getattr(importlib.import_module(f"reproduction.{module}"), function)


def functions_that_judge():
    found = set()
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and node.returns is not None:
                is_top = node.col_offset == 0
                if is_top and ast.unparse(node.returns).split(".")[-1] == "Finding":
                    found.add(f"{path.parent.name}.{path.stem}.{node.name}")
    return found


def calls(path, name):
    return [
        node
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] == name
    ]


@pytest.mark.parametrize("name", YES_PARTLY_NO)
def test_a_claim_can_be_confirmed_confirmed_in_part_and_refuted(name):
    verdicts = [judge(name)(*arguments).holds.value for arguments in YES_PARTLY_NO[name]]
    assert verdicts == ["yes", "partly", "no"]


def test_no_judge_is_left_out():
    assert functions_that_judge() == set(YES_PARTLY_NO)


def test_findings_are_made_by_judges_alone():
    for path in MODULES:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        judges = [
            (node.lineno, node.end_lineno)
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef)
            and f"{path.parent.name}.{path.stem}.{node.name}" in YES_PARTLY_NO
        ]
        for call in calls(path, "Finding"):
            assert any(first <= call.lineno <= last for first, last in judges), path


def test_every_claim_says_by_which_rule_it_is_judged():
    for path in MODULES:
        for call in calls(path, "Claim"):
            assert len(call.args) == 4, f"{path.name}:{call.lineno}"
            rule = ast.unparse(call.args[3])
            assert "yes: " in rule or rule in ("rule", "_RULE"), f"{path.name}:{call.lineno}"


def test_the_best_rival_of_table_2_is_that_of_the_comparison():
    assert apf_table2.COMPARISONS[0] is ONE
