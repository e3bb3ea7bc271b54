# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node whose tracker fails on good images."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from failing import ERROR, failing
from tracker_rig import (
    SPEED,
    TARGET,
    Rig,
    diagnostics_of,
    ended_by_failures,
    on_target,
    road,
    values_of,
)

from vehicle_pf_tracker.trackers.base import BaseTracker

pytestmark = pytest.mark.ros


def test_two_errors_in_a_row_start_the_tracker_anew_on_its_target(bench, monkeypatch):
    rig = Rig(bench, on_target())
    frames = road(20)
    rig.play(frames[:10])
    monkeypatch.setattr(BaseTracker, "step", failing(BaseTracker.step, {0, 1}))
    assert rig.play(frames[10:], 10) == ["REJECTED"] + ["TRACKING"] * 9
    failed, anew, *after = [values_of(answer) for answer in rig.modes[10:]]
    assert failed["reason"] == ERROR
    assert anew["regime"] == "start"
    assert anew["event"] == f"the tracker failed twice in a row and has started anew: {ERROR}"
    assert not [values for values in after if "event" in values]
    assert float(after[-1]["x"]) == pytest.approx(TARGET[0] + TARGET[2] / 2 + 19 * SPEED, abs=6)
    told = diagnostics_of(bench, "apf_tracker", lambda table: table["images"] == "20")
    assert (told["restarts after errors"], told["rejected"]) == ("1", "1")


def test_single_errors_start_nothing_anew(bench, monkeypatch):
    rig = Rig(bench, on_target())
    frames = road(8)
    rig.play(frames[:2])
    monkeypatch.setattr(BaseTracker, "step", failing(BaseTracker.step, {0, 2, 4}))
    assert rig.play(frames[2:], 2) == ["REJECTED", "TRACKING"] * 3
    assert "start" not in [values_of(answer).get("regime") for answer in rig.modes[2:]]


def test_a_broken_tracker_ends_its_node(bench, start_process):
    code = (
        "import sys\n"
        "from vehicle_pf_tracker.trackers.base import BaseTracker\n"
        "BaseTracker.step = BaseTracker.start = lambda *_: 1 / 0\n"
        "from vehicle_pf_tracker.ros.executables import main\n"
        "x, y, width, height = map(float, sys.argv[1:])\n"
        "values = {'x': x, 'y': y, 'width': width, 'height': height}\n"
        "words = [w for k, v in values.items() for w in ('-p', f'target.{k}:={v}')]\n"
        "raise SystemExit(main('apf', ['--ros-args', *words]))"
    )
    node = start_process("-c", code, *map(str, TARGET))
    ended_by_failures(bench, node, "/apf_tracker/mode")
