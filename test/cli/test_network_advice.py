# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Advice to use a network, with the line to type."""

import json
import shlex
from pathlib import Path

import pytest

from vehicle_pf_tracker.cli.network_advice import (
    advice_over_sources,
    joined_vehicles,
    network_advice,
)
from vehicle_pf_tracker.trackers.traffic.detection_totals import DetectionTotals

COMMAND = ["vehicle-pf-tracker", "traffic", "my clip.mp4", "--lines", "lines.yaml", "-o", "out"]


def test_few_ambiguous_blobs_are_no_reason():
    assert network_advice(COMMAND, Path("out"), DetectionTotals(images=0)) == []
    assert network_advice(COMMAND, Path("out"), DetectionTotals(images=100, ambiguous=30)) == []


def test_vehicles_without_a_number_are_said_from_one_at_a_time_on():
    few = DetectionTotals(images=100, sized=50, unresolved=40.0)
    assert joined_vehicles(few) == []
    many = DetectionTotals(images=100, sized=50, unresolved=125.0)
    (sentence,) = joined_vehicles(many)
    assert sentence.startswith("about 2.5 vehicles at a time")
    assert sentence.endswith("in 50 of 100 images")


def test_where_no_size_is_known_nobody_can_tell():
    (sentence,) = joined_vehicles(DetectionTotals(images=100, ambiguous=45))
    assert "cannot be told" in sentence
    assert joined_vehicles(DetectionTotals(images=100, ambiguous=30)) == []


@pytest.mark.parametrize(
    "own", [[], ["--detector", "motion"], ["--detector=motion"], ["-o", "out"], ["--output=out"]]
)
def test_the_line_runs_the_same_with_a_network(own):
    found = DetectionTotals(images=100, ambiguous=45)
    (sentence,) = network_advice([*COMMAND, *own], Path("out"), found)
    assert sentence.startswith("in 45% of the images")
    words = shlex.split(sentence.rpartition("apart: ")[2])
    assert words == [*COMMAND[:-2], "--model", "yolox-nano", "-o", "out_yolox-nano"]


@pytest.mark.parametrize("given", [["--video", "a/all.mp4"], ["--video=a/all.mp4"]])
def test_the_line_replaces_no_video(given):
    found = DetectionTotals(images=100, ambiguous=45)
    (sentence,) = network_advice([*COMMAND, *given], Path("out"), found)
    words = shlex.split(sentence.rpartition("apart: ")[2])
    assert "a/all_yolox-nano.mp4" in " ".join(words)
    assert not {"a/all.mp4", "--video=a/all.mp4"} & set(words)


def test_the_line_over_many_sources_names_the_folder_over_all(tmp_path):
    shares = {"east": ("motion", 50), "north": ("motion", 10), "west": ("model", 90)}
    folders = [tmp_path / name for name in (*shares, "failed")]
    for name, (detector, ambiguous) in shares.items():
        (tmp_path / name).mkdir()
        found = {"images_with_detections": 100, "images_with_ambiguous_blobs": ambiguous}
        (tmp_path / name / "run.json").write_text(json.dumps({"detector": detector, **found}))
    command = ["vehicle-pf-tracker", "traffic", "cams/*.mp4", "-o", "all"]
    (sentence,) = advice_over_sources(command, Path("all"), folders)
    assert sentence.startswith("in 1 of 4 sources (east) blobs may have held several vehicles")
    words = shlex.split(sentence.rpartition("apart: ")[2])
    assert words == [*command[:-2], "--model", "yolox-nano", "-o", "all_yolox-nano"]
    assert advice_over_sources(command, Path("all"), folders[1:]) == []
