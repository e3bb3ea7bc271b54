# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`, the flagship: a correlation particle filter with a posterior over visibility.

`tracker` has its step, in the order of the chart in docs/fusion.md, by its `parameters`.

- step: `observe` predicts and observes, `flow_evidence` weighs, `visibility` judges, `follow`
  follows and learns; `schedule` says which costly tasks a frame has
- belief: `state` has the `hypotheses`, and the `verdict` on the frame; `step` the frame, and the
  memory that all share
- measured: `appearance` (filter) and `paint`; `surface_flow`, `surface_points`; `size_search`
- cut by the image's border at first: `entering`, by `moments` in which the box was followed
- hidden: `perspective` predicts, by sightings that `standing_occluder` restores;
  `followed_by_camera` where the camera moves
- reported: `sides` of the box, by what the network of `image/patches` has learnt; before a standing
  camera by `moving_edges` between `moments` and by the background, to which `anchoring` moves it
- where a hidden vehicle cannot be: `exclusion`, `behind`
- before a standing camera outlines (`outline_boxes`) show what turns (`turning`), comes out beside
  the path (`emergence`), or covers the vehicle (`hidden_way`)
- gone: `departure`
"""
