# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import argparse

import pytest

from vehicle_pf_tracker.cli import replay
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.requests import add_options, request_of
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.results.estimates import EstimateRow, read_estimates
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replay_report import NodeReport, ReplayReport


def parse(*words):
    parser = argparse.ArgumentParser()
    add_options(parser, replay.Request)
    parser.set_defaults(command=[])
    return request_of(replay.Request, parser.parse_args(["bag", *words]))


def options(*words):
    return replay.options_of(parse(*words))


def test_without_options_the_defaults_hold():
    assert options() == ReplayOptions()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("-r 2", {"rate": 2.0}),
        ("--rate 0.5", {"rate": 0.5}),
        ("--start-offset 3 --playback-duration 4.5", {
            "start_offset": 3.0, "playback_duration": 4.5,
        }),
        ("-l", {"loop": True}),
        ("-d 1.5", {"delay": 1.5}),
        ("--topics /a b", {"topics": ("/a", "/b")}),
        ("-m /a:=/b c:=d --remap /e:=/f", {"remap": {"/a": "/b", "/c": "d", "/e": "/f"}}),
        ("--clock", {"clock": 40.0}),
        ("--clock 100", {"clock": 100.0}),
        ("--wait-for-subscribers", {"wait_for_subscribers": True}),
        ("--lockstep --decompress", {"lockstep": True, "decompress": True}),
        ("--node a --node b", {"nodes": ("a", "b")}),
        ("--target 1,2.5,3,4", {"target": Box(1.0, 2.5, 3.0, 4.0)}),
        ("--no-target", {"set_target": False}),
        ("--timeout 3", {"timeout": 3.0}),
        ("--lockstep --ros-args -r __ns:=/x --log-level info", {
            "lockstep": True, "ros_args": ("-r", "__ns:=/x", "--log-level", "info"),
        }),
        ("--ros-args", {}),
    ],
)  # fmt: skip
def test_words_become_options(words, expected):
    assert options(*words.split()) == ReplayOptions(**expected)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("-r 0", "0 is not more than 0"),
        ("-r fast", "'fast' is not a number"),
        ("-r nan", "'nan' is not a number"),
        ("--start-offset -1", "-1 is less than 0"),
        ("--clock 0", "not more than 0"),
        ("-m /a", "'/a' is not FROM:=TO"),
        ("-m :=/b", "':=/b' is not FROM:=TO"),
        ("--target 1,2,3", "not x,y,w,h"),
        ("--timeout 0", "not more than 0"),
    ],
)
def test_words_that_do_not_fit_are_usage_errors(capsys, words, told):
    with pytest.raises(SystemExit) as ended:
        parse(*words.split())
    assert ended.value.code == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("--target 1,2,3,4 --no-target", "--target is not allowed with --no-target"),
        ("--loop -o out", "-o cannot be combined with --loop"),
    ],
)
def test_options_that_contradict_each_other_are_usage_errors(words, told):
    with pytest.raises(UsageError, match=told):
        replay.run(parse(*words.split()))


def test_a_loop_has_no_estimates_to_write():
    with pytest.raises(UsageError, match="never ends"):
        replay.run(parse("--loop", "-o", "out"))


def report(*answered, interrupted=False):
    nodes = tuple(
        NodeReport(f"/ns/{index}_tracker", count, (EstimateRow.without(1, 5, f"MODE{index}"),))
        for index, count in enumerate(answered)
    )
    return ReplayReport(30, 2.0, nodes, interrupted=interrupted)


def test_summary_counts_frames_and_answers_of_each_node():
    assert replay.summary(report(30, 28)).splitlines() == [
        "played 30 frames in 2.0 s (15.0 frames/s)",
        "/ns/0_tracker: 30 answered, 0 not",
        "/ns/1_tracker: 28 answered, 2 not",
    ]
    assert replay.summary(report(interrupted=True)).startswith("interrupted after 30 frames")


def test_one_node_writes_into_the_folder_itself(tmp_path):
    nodes = report(1).nodes
    replay.write_answers(tmp_path / "out", nodes)
    assert read_estimates(tmp_path / "out" / "estimates.csv") == list(nodes[0].rows)


def test_several_nodes_have_folders_of_their_own(tmp_path):
    replay.write_answers(tmp_path, report(1, 1).nodes)
    paths = sorted(tmp_path.glob("*/estimates.csv"))
    assert [path.parent.name for path in paths] == ["ns_0_tracker", "ns_1_tracker"]
    assert [read_estimates(path)[0].mode for path in paths] == ["MODE0", "MODE1"]
