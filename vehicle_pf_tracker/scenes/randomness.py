# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Named random streams: what one part of a scene draws never shifts another part's numbers."""

from __future__ import annotations

import zlib

import numpy as np

from vehicle_pf_tracker.core.errors import InputError


def stream(seed: int, name: str, index: int = 0) -> np.random.Generator:
    """Make the generator of the part `name` of a scene, for its frame or copy `index`."""
    return np.random.default_rng([seed, zlib.crc32(name.encode()), index])


def check_seed(seed: int) -> int:
    """Return `seed` if a scene can be made from it.

    Raises
    ------
    InputError
        If it is not an integer >= 0.
    """
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError(f"the seed of a scene must be an integer >= 0, got {seed!r}")
    return seed
