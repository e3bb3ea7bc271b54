# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Faulty images and targets for a running node, each in lock-step through Fast DDS."""

from __future__ import annotations

import random
import time

from laboratory.faults.drive import TARGET_BOX, Drive
from laboratory.faults.faulty_messages import FaultyMessages
from laboratory.faults.ledger import Ledger
from laboratory.faults.node_process import NodeProcess, Tester


def give_messages(tester: Tester, variant: str, count: int, seed: int) -> bool:
    """Send messages, half of them good images; return whether all held.

    The others are faulty images, and targets that may be anything. Every image has to be answered
    once, and a good one to have an estimate.

    Raises
    ------
    FaultError
        At the first that is not.
    """
    drive = Drive()
    draw = random.Random(seed)
    faults = FaultyMessages(drive.image, seed)
    sides = zip(("x", "y", "width", "height"), TARGET_BOX, strict=True)
    words = [f"target.{name}:={value}" for name, value in sides]
    # A deep queue, so that none is dropped, and few particles, so that thousands are soon through.
    node = NodeProcess(tester, variant, "queue_depth:=50", "num_particles:=50", *words)
    ledger = Ledger(node)
    ledger.begin(tester, drive.image(0))
    weighed = 0.0
    for number in range(1, count + 1):
        # Half good ones: a node has to come back to its work after every fault.
        kind = draw.choices(["good", "faulty", "target"], [5, 4, 1])[0]
        if kind == "target":
            node.give_target(faults.target())
            ledger.counts["targets"] += 1
            continue
        is_good = kind == "good"
        image = drive.image(number) if is_good else faults.image(number)
        ledger.take(tester, image, is_good=is_good)
        # Two faulty sizes or times that agree with no good image between have to be believed.
        if is_good:
            faults.note_good()
        # Once a second: reading it costs time, too.
        if time.monotonic() >= weighed + 1:
            weighed = time.monotonic()
            ledger.weigh()
    ledger.close()
    return ledger.report()
