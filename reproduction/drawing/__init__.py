# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What several experiments draw.

- `case_figure`: errors by case and tracker
- `bands`: median and range over the frames
- `shading`: occlusions behind a plot over the frames
- `strips`: frames side by side, with the boxes of trackers
"""
