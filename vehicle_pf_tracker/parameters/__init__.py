# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters: the table that everything else is derived from, its files, a node's configuration.

Of the other rooms it imports `core` and `road` alone.
"""
