# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Windows around many positions, such as particles, each described by a histogram.

- `window`: a window, and what a feature is
- features: `colour`, `gradients` (edges), `textures`; and `lines`
- `bin_counting`: counts of a feature's bins in many windows at once
- `box_colours`: colours of boxes of any size
- `similarity`: comparison of histograms with a reference
- `mean_shift`: windows that climb to the most similar position
"""
