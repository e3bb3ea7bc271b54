# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fast measurement of windows: one interface, implemented in OpenCV and numpy, and in numba.

`interface` has the kernels of OpenCV and numpy, and chooses. `numba_kernels` are numba's; they call
modules of compiled functions: `numba_pixel_cells` (bin of each pixel), `numba_windows` (counts and
similarities of windows), `numba_gradients`, `numba_edges` and `numba_counts` (edge points),
`numba_mean_shift` and `numba_cells` (oriented gradients), for `numba_types`.

A function becomes a `kernel`: `compilation` by numba makes `object_code`, which `kernel_store`
keeps on disk and `linking` loads without numba; `arguments` are checked at each call.
"""
