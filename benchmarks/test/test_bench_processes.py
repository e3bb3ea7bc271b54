# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measured nodes: the words that they are started with, their processes and meters."""

import ast
import importlib
import time
from pathlib import Path

from benchmarks.bench.metered_node import METER_RECORD
from benchmarks.bench.processes import NodeProcess, StepMeter, tracker_words


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


def test_a_node_that_says_much_after_it_is_ready_is_not_stopped(tmp_path):
    """A pipe holds 64 KiB: a node whose words nobody reads would stop at them."""
    done = tmp_path / "done"
    code = (
        "import pathlib, sys, time\n"
        "print('ready:', file=sys.stderr, flush=True)\n"
        "sys.stderr.write('x' * 1_000_000)\n"
        "sys.stderr.flush()\n"
        f"pathlib.Path({str(done)!r}).touch()\n"
        "time.sleep(60)\n"
    )
    with NodeProcess(["-c", code]):
        deadline = time.monotonic() + 20
        while not done.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
    assert done.exists()
