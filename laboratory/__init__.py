# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs that fit, judge and compare the trackers; not installed.

- `fusion/` and `traffic/`: what these two trackers reach, and their fits
- `stress/`: difficult cases made of recordings, for every tracker (`python -m laboratory stress`)
- `faults/`: faults given to nodes and commands (`python -m laboratory faults`)
- `scenes/`: synthetic scenes that only these programs and the papers' experiments need
- `uncertainty/`: fit of the covariances, and how often their ellipses hold the truth
- `train_sides`: the network that sees the sides of vehicles, by `side_examples` and
  `side_training`
- `count_trust`: fit of how far a count can be trusted
- `road_speed`, `target_contrast`: errors of speeds, and contrast of true and of thrown boxes
- `readme_table`: README's table
- `notes/`: what was tried and measured

The programs share `result_store` (results kept by key) and `figure_files`.
"""
