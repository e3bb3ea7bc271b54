# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One target at a canonical size, and the correlation filter that finds it again.

In the order of its use:

- `canonical_patch`: surroundings of the target, resampled so that it has a canonical size, by
  `affine_sampling`
- `gradient_cells`: the patch as cells of oriented gradients
- `spectra`: their Fourier transform, with `row_waves`
- `correlation_filter`: learning from them, and response to the next ones
- `map_search`: best value of a map, such as the response, close to given positions
"""
