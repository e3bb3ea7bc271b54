# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`set-target` gives a node its target through Fast DDS, and says when there is no such node."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from tracker_rig import TARGET, Rig, overrides, road, values_of

pytestmark = pytest.mark.ros


@pytest.fixture
def set_target(start_process):
    """Return a function that runs the command."""

    def start(*words):
        code = "import sys; from vehicle_pf_tracker.cli.main import main; sys.exit(main())"
        return start_process("-c", code, "set-target", *words)

    return start


@pytest.mark.parametrize("shift", [pytest.param(0, marks=pytest.mark.slow), 0.25])
def test_the_node_starts_on_the_target(bench, set_target, shift):
    rig = Rig(bench, overrides(publish__box=True))
    assert rig.show_frame(road(1)[0], 0).status[0].message == "WAITING"
    x, y, width, height = TARGET
    process = set_target("apf_tracker", f"{x + shift},{y},{width},{height}")
    bench.wait_for(lambda: process.popen.poll() is not None)
    assert process.wait() == 0, process.output
    box = f"{x + shift:g},{y},{width},{height}"
    said = f"/apf_tracker has the target {box}: it starts with the next image\n"
    assert process.output == said
    answer = rig.show_frame(road(1)[0], 1)
    assert answer.status[0].message == "TRACKING"
    assert float(values_of(answer)["x"]) == pytest.approx(x + shift + width / 2, abs=1e-3)


def test_without_such_a_node_it_says_which_there_are(bench, set_target):
    Rig(bench)
    process = set_target("apf_trackr", "1,2,30,40", "--timeout", "10")
    bench.wait_for(lambda: process.popen.poll() is not None)
    assert process.wait() == 1
    assert process.output == (
        "vehicle-pf-tracker: error: there is no node /apf_trackr that takes targets after 10 s: "
        "there is /apf_tracker\n"
    )


def test_with_no_node_at_all_it_asks(set_target):
    process = set_target("apf_tracker", "1,2,30,40", "--timeout", "0.5")
    assert process.wait() == 1
    assert "after 0.5 s: is it running and active?" in process.output


@pytest.mark.parametrize(
    ("box", "said"),
    [
        ("1,2,30", "is not x,y,w,h in px"),
        ("1,2,0,40", "the box 1,2,0,40 has no area"),
        ("1,2,30,nan", "not finite"),
    ],
)
def test_a_wrong_box_is_a_mistake_of_usage(set_target, box, said):
    process = set_target("apf_tracker", box)
    assert process.wait() == 2
    assert said in process.output
