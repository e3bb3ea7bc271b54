# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The first paper (P1, Scharcanski et al. 2011): its figures and tables.

`systems` has the artificial video, the six trackers and the interpretations that claims are judged
under; `video3` is the common part of figures 5 to 7, and `published` has the numbers that table II
is compared with. Each other module is one experiment; `paper` lists them.
"""
