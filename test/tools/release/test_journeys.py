# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The ways of the README: their commands, and judges that notice what went wrong."""

import pytest

from tools import ROOT
from tools.release import journeys

MODES = ("TRACKING", "OCCLUDED", "TRACKING", "OCCLUDED", "TRACKING")


def estimates(modes, step_ms="1.0"):
    return "frame,mode,x,step_ms\n" + "".join(
        f"{frame},{mode},{frame}.5,{step_ms}\n" for frame, mode in enumerate(modes)
    )


@pytest.fixture
def left(tmp_path):
    """A folder with all that the ways leave, as it should be."""
    for names in journeys.WRITTEN.values():
        for name in names:
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text("something")
    for name in ("out", "replayed", "offline"):
        (tmp_path / name).mkdir(exist_ok=True)
        (tmp_path / name / "estimates.csv").write_text(estimates(MODES))
    (tmp_path / "offline" / "estimates.csv").write_text(estimates(MODES, step_ms="2.0"))
    write_errors(tmp_path, 2.0, 120.0)
    return tmp_path


def write_errors(folder, of_fusion, of_pf):
    (folder / "results" / "summary.csv").write_text(
        "recording,system,metric,mean\nall,fusion,iou,0.1\n"
        f"all,fusion,rmse_px,{of_fusion}\nall,pf,rmse_px,{of_pf}\n"
    )


@pytest.mark.parametrize("extra", journeys.WRITTEN)
def test_what_should_be_left_is_good_and_what_lacks_is_named(left, extra):
    assert journeys.problem(extra, left) == ""
    for name in journeys.WRITTEN[extra]:
        (left / name).rename(left / "moved")
        assert journeys.problem(extra, left) == f"there is no {name}"
        (left / name).touch()
        assert journeys.problem(extra, left) == f"there is no {name}"
        (left / "moved").replace(left / name)


def test_a_vehicle_that_is_lost_is_noticed(left):
    (left / "out" / "estimates.csv").write_text(estimates(("TRACKING", "OCCLUDED", "LOST")))
    assert journeys.problem("video", left) == "the vehicle is TRACKING, OCCLUDED, LOST"


def test_another_estimate_of_the_node_is_noticed(left):
    (left / "replayed" / "estimates.csv").write_text(estimates(MODES).replace("3.5", "3.6"))
    assert "not those of a run without ROS" in journeys.problem("ros", left)


def test_a_worse_fusion_is_noticed(left):
    write_errors(left, 120.0, 2.0)
    assert journeys.problem("evaluation", left) == "RMSE, px: {'fusion': 120.0, 'pf': 2.0}"


def test_the_commands_are_those_of_the_pages():
    pages = [(ROOT / name).read_text() for name in ("README.md", "docs/first_steps.md")]
    for extra, written in journeys.WRITTEN.items():
        lines = journeys.commands(extra).splitlines()
        assert all(name.split("/")[0] in "\n".join(lines) for name in written)
        assert [line for line in lines if not any(line in page for page in pages)] == []
