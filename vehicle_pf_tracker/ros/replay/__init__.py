# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The replay of a recording to nodes.

- `replaying` is the whole of it, by `replay_options`, and returns a `replay_report`
- the player: `player` publishes (`publishing`, with the `recorded_qos`) at its `pace`; `pausing`
- the nodes: found by `discovery`; `tracker_links` has a `tracker_link` to each, which collects its
  `answers`; `starting_target` is what they start on
- `launched_replay`: the replay that a launch file starts beside its node
"""
