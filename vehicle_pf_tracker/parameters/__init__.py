# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters: the table that everything else is derived from, its files, a node's configuration.

`table` makes and checks them, `files` reads and writes YAML, `configuration` joins those of a
variant and of a node; `road` and `counting_plan` are groups that users draw or measure. Of the
other rooms it imports `core` and `road` alone.
"""
