# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes for experiments, beside those of the package.

    python -m laboratory.scenes SCENE OUT

writes one, as `vehicle-pf-tracker synth` writes those of the package. `catalogue` has all by name.

- One target, in the package's view from beside the road: `turns`, `drives`, `light`, and `depth`,
  in which it changes its size.
- One target on a `road` in perspective: `perspective` draws vehicles as a camera sees them, and
  `road_ground` the road.
- Many vehicles (`traffic_scene`), with the truth about each: their `flow` comes of a
  `driver_model`. `traffic_perspective` shows them from a gantry or a mast, `traffic_close` from
  nearby. `conditions` put weather and light before them, and a `mot_folder` is written with
  detections of a `simulated_detector`.
"""

from laboratory.scenes.catalogue import (
    LABORATORY_SCENES,
    TRAFFIC_SCENES,
    make_scene,
    make_traffic_scene,
)

__all__ = ["LABORATORY_SCENES", "TRAFFIC_SCENES", "make_scene", "make_traffic_scene"]
