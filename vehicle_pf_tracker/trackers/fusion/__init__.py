# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`, the flagship: a correlation particle filter with a posterior over visibility.

`tracker` has its step, in the order of the chart in docs/fusion.md, by its `parameters`.

- step: `observe` predicts and observes, `flow_evidence` weighs, `visibility` judges, `follow`
  follows and learns; `schedule` says which costly tasks a frame has
- belief: `state` has the `hypotheses`, and the `verdict` on the frame; `step` the frame, and the
  memory that all share
- measured: `appearance` (filter) and `paint`; `surface_flow`, `surface_points`; `size_search`
- a first box that the image's border cuts: `entering`, by images of three `moments`
- hidden: `perspective` predicts, by sightings that `standing_occluder` restores;
  `followed_by_camera` where the camera moves
- reported: `sides` of the box, measured by the network of `image/patches` and, before a standing
  camera, by `moving_edges` between `moments` and by edges against the background; `anchoring` moves
  the followed box and retrains the filter
- where a hidden vehicle cannot return: `exclusion`, `behind`
- before a standing camera outlines (`outline_boxes`) show a turn (`turning`), a vehicle that
  appears beside its path (`emergence`), or that something covers its path (`hidden_way`)
- gone: `departure`
"""
