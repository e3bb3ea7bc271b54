# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node of many vehicles whose tracker fails on good images."""

from __future__ import annotations

import socket

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from failing import ERROR, failing
from tracker_rig import diagnostics_of, ended_by_failures, overrides, values_of
from traffic_rig import NODE, WARM_UP, TrafficRig, boxes, lanes

from vehicle_pf_tracker.showing.live_page import LivePage
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

pytestmark = pytest.mark.ros

FIRST, COUNT = WARM_UP + 10, 16


def test_two_errors_in_a_row_start_anew_with_the_target_given_by_hand(bench, monkeypatch):
    x, y, width, height = map(float, boxes(FIRST)[0])
    target = overrides(target__x=x, target__y=y, target__width=width, target__height=height)
    rig = TrafficRig(bench, [*target, *overrides(detector__kind="none")])
    frames = lanes(FIRST + COUNT)[FIRST:]
    rig.play(frames[:8])
    monkeypatch.setattr(MultiVehicleTracker, "step", failing(MultiVehicleTracker.step, {0, 1}))
    answers = rig.play(frames[8:], 8)
    assert [one.status[0].message for one in answers] == ["REJECTED"] + ["TRACKING"] * 7
    failed, anew, *after = map(values_of, answers)
    assert failed["reason"] == ERROR
    assert anew["event"] == f"the tracker failed twice in a row and has started anew: {ERROR}"
    assert not [values for values in after if "event" in values]
    # The selection goes with the vehicle, which has a new number.
    assert {values["id"] for values in (anew, *after)} == {"2"}
    end = boxes(FIRST + COUNT - 1)[0]
    assert float(after[-1]["x"]) == pytest.approx(end[0] + end[2] / 2, abs=end[2] / 3)
    told = diagnostics_of(bench, "traffic_tracker", lambda table: table["images"] == "16")
    assert (told["restarts after errors"], told["rejected"]) == ("1", "1")


def test_a_broken_tracker_ends_its_node(bench, start_process):
    code = (
        "from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker\n"
        "MultiVehicleTracker.step = lambda *_: 1 / 0\n"
        "from vehicle_pf_tracker.ros.executables import main\n"
        "raise SystemExit(main('traffic', []))"
    )
    ended_by_failures(bench, start_process("-c", code), f"{NODE}/mode")


def test_a_page_that_cannot_be_drawn_costs_no_image_its_answer(bench, monkeypatch):
    rig = TrafficRig(bench, overrides(page_port=0))
    monkeypatch.setattr(LivePage, "show", failing(LivePage.show, {0, 1, 2, 3}))
    assert len(rig.play(lanes(4))) == 4


def test_a_port_that_is_taken_costs_the_page_alone(bench):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        rig = TrafficRig(bench, overrides(page_port=taken.getsockname()[1]))
        assert rig.node.outputs.page is None
        assert len(rig.play(lanes(4))) == 4
