# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The third paper (P3, Khong et al.): its figures.

`systems` has both filters, their resampling schemes, the interpretations and the two scenes. Each
other module is one experiment; `paper` lists them.
"""
