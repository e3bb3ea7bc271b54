# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`python -m vehicle_pf_tracker`: the command line where its console script is not on PATH."""

import sys

from vehicle_pf_tracker.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
