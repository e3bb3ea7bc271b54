# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`compile`: fill the cache of compiled kernels, so that no start has to."""

from __future__ import annotations

import time

from vehicle_pf_tracker.cli.console import tell_notices
from vehicle_pf_tracker.cli.requests import VerbRequest
from vehicle_pf_tracker.core.errors import InputError

Request = VerbRequest
"""Request of `compile`, which has no options."""


def run(request: Request) -> int:
    """Compile what is not compiled yet, and say how long it took; 1 if it cannot be kept."""
    from vehicle_pf_tracker.image.kernels.interface import compile_all

    print("compiling kernels, for up to a minute; later starts load them", flush=True)
    began = time.monotonic()
    try:
        kernels = compile_all("numba")
    except InputError as error:
        raise InputError(
            "there is nothing to compile without Numba: install the extra [numba], pip install "
            f"'vehicle_pf_tracker[numba]' ({error.__cause__})"
        ) from None
    tell_notices(kernels.notices)
    print(f"kernels are ready after {time.monotonic() - began:.1f} s")
    return 1 if kernels.notices else 0
