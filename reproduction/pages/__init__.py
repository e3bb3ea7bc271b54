# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Results as files.

- `output`: the folder of one experiment
- `page`: all of them joined to docs/reproduction.md, with the verdicts as data beside it
- `page_text`: the words of that page
"""
