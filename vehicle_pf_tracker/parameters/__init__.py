# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters: the table that everything else is derived from, its files, a node's configuration."""
