# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""How functions in Python become compiled kernels, whatever they compute.

A `kernel` is compiled when it is first called (`compilation`, by numba, and with
`whole_kernels` without machine code of its parts). Its `object_code` is kept on disk
(`kernel_store`), and `linking` makes a function of it in later processes, whose first `arguments`
are checked.
"""
