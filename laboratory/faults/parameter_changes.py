# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters that running trackers are given, one after the other, and back."""

from __future__ import annotations

# Changes in their order, of every effect, each undone later.
CHANGES: list[tuple[str, object]] = [
    ("num_particles", 300),
    ("histogram_bits", 4),  # of the reference's effect "relearns"
    ("lost_after", 1.0),
    ("seed", 5),
    ("publish.velocity", False),
    ("num_particles", 100),
    ("window.width", 14.0),
    ("histogram_bits", 3),
    ("publish.velocity", True),
    ("evidence.clear_above", 0.85),
    ("seed", 6),
    ("window.width", 0.0),
    ("lost_after", 5.0),
    ("evidence.clear_above", 0.8),
    ("num_particles", 200),
]
