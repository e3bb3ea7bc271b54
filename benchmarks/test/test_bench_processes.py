# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Words that the measured nodes are started with."""

import ast
import importlib
from pathlib import Path

from benchmarks.bench.metered_node import METER_RECORD
from benchmarks.bench.processes import StepMeter, tracker_words


def test_a_metered_node_gets_target_image_and_parameters():
    meter = StepMeter()
    words = tracker_words("pf", "/camera", meter, queue_depth=10, publish__box=False)
    assert words[:4] == ["-m", "benchmarks.bench.metered_node", meter.path, "pf"]
    assert {"target.x:=20.0", "target.width:=40.0", "queue_depth:=10"} <= set(words)
    assert {"publish.box:=False", "image:=/camera"} <= set(words)


def test_a_node_without_a_meter_is_started_by_what_the_package_has():
    tree = ast.parse(tracker_words("pf", "/camera")[1])
    (imported,) = (one for one in tree.body if isinstance(one, ast.ImportFrom))
    module = importlib.import_module(imported.module)
    assert all(callable(getattr(module, one.name)) for one in imported.names)


def test_the_meter_reads_what_a_node_writes():
    meter = StepMeter()
    assert meter.cpu_seconds == 0
    Path(meter.path).write_bytes(METER_RECORD.pack(1.5, 3))
    assert meter.cpu_seconds == 1.5
