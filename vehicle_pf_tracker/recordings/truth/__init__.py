# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth in files: where it lies beside images, its formats, and the rows of one target.

`files` looks for it and chooses the target. `formats` has a row for each format, and tells them
apart; `data_sets` and `annotation_tools` read them, each as `labels`.
"""
