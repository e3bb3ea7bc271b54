# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Puts this folder on the path, so that the tests below it find `feature_samples`."""
