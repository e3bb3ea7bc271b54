# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The second paper (P2, Abdulla et al. 2022): its figures and tables.

`systems` has the four filters, their interpretations and the six cases. Drawn by several
experiments: `case_plots` over the frames of each case, `share` in percent. `textures` belongs to
`table1`. Each other module is one experiment; `paper` lists them.
"""
