# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurements in the image: windows, histograms, gradients, templates, similarity."""
