# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Environment of commands that coverage does not follow: ended by a signal, or long."""

import os


def unmeasured_environment():
    """Return the environment without what starts coverage in a child process.

    A signal handler that raises may do so while coverage's tracer holds its lock, which the
    child then waits for at its end, for ever.
    """
    return {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
