# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`, the flagship: a correlation particle filter with a posterior over visibility."""
