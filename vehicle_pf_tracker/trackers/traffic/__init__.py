# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every vehicle in view: found, followed through occlusions, with identities that last.

`tracker` has the step and `observe` its part about detections, both as docs/traffic.md has them;
`parameters` are the user's.

- state: `state` has the `tracks`, frozen `rows` of arrays: Gaussians (`vehicle_state`), whose edges
  `edge_observation` has, and `paths`; and the `horizon`
- step: `prediction`, `occlusion`, `observe`, `pixel_hold`, `ending`, `recognition`
- detections: `candidates` weighs them by `detection_evidence`, and `association` pairs them;
  `parts` divides boxes, and `correction` measures their edges (`box_edges`)
- evidence: `existence` adds that of detections, `driving` tests for drives, `misses` takes off that
  of missed detections by the `detection_rate`
- births: `births` begins tracks, whose `first_state` is by the road's `speeds`
- one number for one vehicle: `identity`, by `colours`, and `bodies`
- results: `report` makes an `estimate` of each; `session` follows a stream of images, and keeps
  `detection_totals`
"""
