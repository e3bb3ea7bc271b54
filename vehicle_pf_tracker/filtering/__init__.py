# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Particle filtering in plain numpy: weights, resampling, motion samplers.

Of the other rooms it imports `core` alone. P1, P2 and P3 are the papers of docs/interpretations.md,
which numbers the interpretations of them.
"""
