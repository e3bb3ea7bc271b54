# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Work shared among the processes of this machine, or the machines of a cluster.

Both call one function with many tasks, and yield each task with its result. They know nothing of
what the tasks are.
"""
