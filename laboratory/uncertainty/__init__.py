# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Calibration of the covariances: `python -m laboratory.uncertainty run`, `fit` or `report`.

- `tracking`: runs of the variants over scenes and cameras
- `runs`: what is kept of them, and their errors in units of a covariance
- `fit`: a variant's calibration; `table_module` writes those of all into the package
- `coverage`, `picture`: how often the ellipses hold the truth, as table and as picture
"""
