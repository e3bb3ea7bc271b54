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

"""`compile`: fill the cache of compiled kernels, so that no start has to."""

from __future__ import annotations

import time

from vehicle_pf_tracker.cli.console import tell_notices
from vehicle_pf_tracker.cli.requests import VerbRequest

Request = VerbRequest
"""Request of `compile`, which has no options."""


def run(request: Request) -> int:
    """Compile what is not compiled yet, and say how long it took; 1 if it cannot be kept."""
    from vehicle_pf_tracker.image.kernels.interface import load_kernels

    print("compiling kernels, for up to a minute; later starts load them", flush=True)
    began = time.monotonic()
    kernels = load_kernels("numba")
    tell_notices(kernels.notices)
    print(f"kernels are ready after {time.monotonic() - began:.1f} s")
    return 1 if kernels.notices else 0
