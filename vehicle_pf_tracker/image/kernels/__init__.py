# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fast measurement of windows: one interface, implemented in OpenCV and numpy, and in numba.

`interface` has the kernels of OpenCV and numpy, and chooses. `numba_kernels` are numba's; they call
modules of compiled functions: `numba_placing` (part of a frame that windows cover),
`numba_pixel_cells` (bin of each pixel), `numba_windows` (similarities of windows, by
`numba_sliding` where they share pixels, each by `numba_similarity`), `numba_gradients`,
`numba_edges` and `numba_counts` (edge points), `numba_box_colours`, `numba_box_motion`,
`numba_mean_shift`, `numba_cells` (oriented gradients), `numba_row_waves` (a part of Fourier
transforms) and `numba_map_search` (the best value of a map close by), with types from
`numba_types`.

`toolchain/` compiles each kernel when it is first called, and keeps it for later processes.
"""
