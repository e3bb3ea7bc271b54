# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Advice to use a network, with the line to type."""

import shlex
from pathlib import Path

import pytest

from vehicle_pf_tracker.cli.network_advice import network_advice
from vehicle_pf_tracker.trackers.traffic.session import DetectionTotals

COMMAND = ["vehicle-pf-tracker", "traffic", "my clip.mp4", "--lines", "lines.yaml", "-o", "out"]


def test_few_ambiguous_blobs_are_no_reason():
    assert network_advice(COMMAND, Path("out"), DetectionTotals(images=0)) == []
    assert network_advice(COMMAND, Path("out"), DetectionTotals(images=100, ambiguous=30)) == []


@pytest.mark.parametrize("own", [[], ["--detector", "motion"], ["--detector=motion"]])
def test_the_line_runs_the_same_with_a_network(own):
    found = DetectionTotals(images=100, ambiguous=45)
    (sentence,) = network_advice([*COMMAND, *own], Path("out"), found)
    assert sentence.startswith("in 45% of the images")
    words = shlex.split(sentence.rpartition("apart: ")[2])
    assert words == [*COMMAND, "--model", "yolox-nano", "-o", "out_yolox-nano"]
