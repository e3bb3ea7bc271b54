# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes of the papers' experiments (`paper_scenes`), and the `signs` that hide vehicles there."""
