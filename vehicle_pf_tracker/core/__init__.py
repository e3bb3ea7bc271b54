# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types and rules that every room uses: frames, boxes, stamps, ground truth, input errors.

It imports no other room. docs/development.md lists the rooms, and what each of them may import.
"""
