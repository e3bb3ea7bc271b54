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

"""Limit on a process's memory that libraries answer with a crash."""

from __future__ import annotations

import resource

from vehicle_pf_tracker.core.errors import InputError

_LEAST = 2**30
"""Bytes of addresses that a node and `run` need for their libraries: with 900 MB compiling kernels
ended the process without a word, with 1000 MB nodes and runs of `apf` and `fusion` ended well."""


def check_address_space() -> None:
    """Refuse a limit (``ulimit -v``) that the libraries do not fit in.

    Raises
    ------
    InputError
        If there is one.
    """
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit not in (-1, resource.RLIM_INFINITY) and limit < _LEAST:
        raise InputError(
            f"memory is limited to {limit / 1e6:.0f} MB (ulimit -v); {_LEAST / 1e6:.0f} MB are "
            "needed"
        )
