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

"""Delivery of images sent to several nodes at once."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Delivery:
    """Images sent to `nodes` nodes at `rate_hz` each, reliably.

    Attributes
    ----------
    sent, lost : int
        Images that were published, and those that no estimate was given for.
    cpu_ms : float
        CPU of all processes for each image.
    memory_mb : float
        Resident memory of all processes, what they share counted once.
    """

    name: str
    nodes: int
    rate_hz: float
    sent: int
    lost: int
    cpu_ms: float
    memory_mb: float
