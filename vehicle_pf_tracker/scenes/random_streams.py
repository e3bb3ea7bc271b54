# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Random streams by name, so that what one part of a scene draws never shifts another."""

from __future__ import annotations

import zlib

import numpy as np


def stream(seed: int, name: str, index: int = 0) -> np.random.Generator:
    """Make the generator of the part `name` of a scene, for its frame or copy `index`."""
    return np.random.default_rng([seed, zlib.crc32(name.encode()), index])
