# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubts about a target, which are reported to the user.

- `target_pixels`: before it is followed, by its size and contrast
- `stillness`: while it is followed, as it does not move while other things do
"""
