# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cost of a tracker node over the floor, and images lost by many nodes at once."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped, Vector3Stamped

from benchmarks.bench.camera import Camera
from benchmarks.bench.case import Case
from benchmarks.bench.delivery import Delivery
from benchmarks.bench.effort import Effort
from benchmarks.bench.memory import MemoryCase
from benchmarks.bench.processes import (
    NodeProcess,
    StepMeter,
    container_words,
    floor_words,
    tracker_words,
)
from benchmarks.bench.resident import proportional_mb

RATE = 30.0
"""Images per second that one node gets, those of an ordinary camera."""
FLEET_RATE = 15.0
"""Images per second that each of several nodes gets: eight of them are to fit two processors."""
_OUTPUTS = MappingProxyType(
    {"mode": DiagnosticArray, "box": PolygonStamped, "velocity": Vector3Stamped}
)
"""Outputs that somebody hears in the case `all_heard`, beside the position."""


class _Batch(NamedTuple):
    floor: float
    node: float
    step: float


def measure(wanted: Callable[[str], bool], effort: Effort) -> tuple[list[Case], list[MemoryCase]]:
    """Measure ``node/apf`` against the floor, with its step and without, and its memory.

    Raises
    ------
    InputError
        If a node does not start or answer.
    """
    names = "node/apf/without_step", "node/apf/with_step", "node/apf/all_heard"
    # Two runs serve all cases; see `_alternate`.
    if not any(map(wanted, (*names, "memory/node/apf"))):
        return [], []
    batches, memory = _alternate("apf", effort)
    heard, _ = _alternate("apf", effort, _OUTPUTS)
    floor = [batch.floor for batch in batches]
    cases = [
        # The step is measured within the node, and taken off.
        Case.of(names[0], [batch.node - batch.step for batch in batches], floor),
        Case.of(names[1], [batch.node for batch in batches], floor),
        Case.of(names[2], [batch.node for batch in heard], [batch.floor for batch in heard]),
    ]
    return cases, [memory]


def _alternate(
    variant: str, effort: Effort, outputs: Mapping[str, type[Any]] = MappingProxyType({})
) -> tuple[list[_Batch], MemoryCase]:
    """Give images to the floor and to the node in turns: CPU seconds per image of each turn."""
    meter = StepMeter()
    count = effort.batch_frames
    topics = {"/bench/floor": "/floor/position", "/bench/node": f"/{variant}_tracker/position"}
    with (
        NodeProcess(floor_words("/bench/floor")) as floor,
        NodeProcess(tracker_words(variant, "/bench/node", meter)) as node,
        Camera(topics) as camera,
    ):
        camera.hear({f"/{variant}_tracker/{name}": kind for name, kind in outputs.items()})
        # All answer before anything counts: kernels are compiled, discovery is over.
        camera.wait()
        batches = []
        # The two in turns, so that what slows the machine down slows both.
        for _ in range(effort.batches + 1):
            before = floor.cpu_seconds
            camera.batch("/bench/floor", count, RATE)
            of_floor = floor.cpu_seconds - before
            before = node.cpu_seconds
            steps = meter.cpu_seconds
            camera.batch("/bench/node", count, RATE)
            of_node = node.cpu_seconds - before
            of_steps = meter.cpu_seconds - steps
            batches.append(_Batch(of_floor / count, of_node / count, of_steps / count))
        memory = MemoryCase(f"memory/node/{variant}", node.resident_mb, floor.resident_mb)
    return batches[1:], memory  # the first one warms up


def fleet(wanted: Callable[[str], bool], effort: Effort) -> list[Delivery]:
    """Let some nodes of ``apf`` follow at once, each with a camera of its own; reliable, 10.

    They run in a process each, and all in one.

    Raises
    ------
    InputError
        If a node does not start or answer.
    """
    count = effort.fleet_nodes
    # Reliable with a queue of 10: what is lost then was dropped by an overloaded node.
    images = [f"/bench/camera_{number}" for number in range(count)]
    reliable = [f"qos_overrides.{one}.subscription.reliability:=reliable" for one in images]
    options = [word for one in reliable for word in ("-p", one)]
    found = []
    if wanted(name := f"fleet/apf/{count}x640x480"):
        answers = [f"/tracker_{number}/position" for number in range(count)]
        processes = [
            [
                *tracker_words("apf", image, queue_depth=10),
                *("-r", f"__node:=tracker_{number}"),
                *options[2 * number : 2 * number + 2],
            ]
            for number, image in enumerate(images)
        ]
        found.append(_delivery(name, dict(zip(images, answers, strict=True)), processes, effort))
    if wanted(name := f"fleet/container/{count}x640x480"):
        answers = [f"/camera_{number}/apf_tracker/position" for number in range(count)]
        with TemporaryDirectory() as folder:
            words = [*container_words("apf", images, Path(folder, "cameras.yaml")), *options]
            topics = dict(zip(images, answers, strict=True))
            found.append(_delivery(name, topics, [words], effort))
    return found


def _delivery(
    name: str, topics: dict[str, str], processes: list[list[str]], effort: Effort
) -> Delivery:
    with contextlib.ExitStack() as stack:
        nodes = [stack.enter_context(NodeProcess(words)) for words in processes]
        camera = stack.enter_context(Camera(topics))
        camera.wait()
        # Counted from here: images of the wait are not of the stream.
        sent = dict(camera.sent)
        answered = dict(camera.answered)
        before = sum(node.cpu_seconds for node in nodes)
        camera.stream(effort.fleet_seconds, FLEET_RATE)
        cpu = sum(node.cpu_seconds for node in nodes) - before
        total = sum(camera.sent.values()) - sum(sent.values())
        lost = total - (sum(camera.answered.values()) - sum(answered.values()))
        # Proportional, as nodes share most of their libraries.
        memory = sum(proportional_mb(node.pid) for node in nodes)
    return Delivery(name, len(topics), FLEET_RATE, total, lost, cpu / total * 1e3, memory)
