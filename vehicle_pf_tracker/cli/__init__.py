# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command line, one file per verb.

A verb is a module with `run` and a `Request`, whose fields are its options; `main.VERBS` has them.
The other modules hold options and parts that several verbs share.
"""
