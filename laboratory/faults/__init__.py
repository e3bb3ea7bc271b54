# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Faults that cameras, detectors, files and people make, given to nodes and commands.

`command` is ``python -m laboratory faults``, `request` its options, and `kinds` leads each kind of
fault to its trial:

- ``messages`` (`messages_trial`): faulty images and targets (`faulty_messages`) for one node, in
  lock-step, among the good images of a `drive`.
- ``parameters``, ``recordings`` (`files_trial`): files with `damage`, read by commands and a node.
- ``detector`` (`detector_trial`): each way in which a `detector` fails, for the node of many
  vehicles, before the traffic of `lanes`.
- ``soak``: several nodes at a camera's rate for hours, on a `bridge_scene`, with a
  `failing_detector`, `faulty_messages` and `parameter_changes`.

All but the files need nodes: a `node_process` each, and its `Tester`, which sends images and hears
answers. The `ledger` judges a node (every image is answered once, and rightly), `numbers` the
numbers that it gives to vehicles. `vision_messages` imports vision_msgs, or builds it.

A trial prints what came of it and returns whether all held, or raises `FaultError` at the first
that did not. ``test/ros/test_faults.py`` runs each kind shortly, and ``docs/soak.md`` has the
results of long runs.
"""
