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

"""Messages about lines and zones."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Header

from vehicle_pf_tracker.ros.messages import key_values
from vehicle_pf_tracker.trackers.traffic.counting import Counter, Crossing
from vehicle_pf_tracker.trackers.traffic.zone_watch import ENTRY, EXIT


def counts_message(
    header: Header,
    node: str,
    hardware_id: str,
    counter: Counter,
    latest: Mapping[str, Crossing],
) -> DiagnosticArray:
    """Make the status of each line and zone.

    Parameters
    ----------
    header : Header
        The image's.
    node, hardware_id : str
        Node, and topic of its images.
    counter : Counter
        What was counted.
    latest : mapping of str to Crossing
        The last crossing of each place, by the place's name.
    """
    directions = {
        **{line.name: line.directions for line in counter.plan.lines},
        **{zone.name: (ENTRY, EXIT) for zone in counter.plan.zones},
    }
    status = [
        DiagnosticStatus(
            level=DiagnosticStatus.OK,
            name=f"{node}: {place}",
            message=_words(counter, place, names),
            hardware_id=hardware_id,
            values=key_values(_values(counter, place, names, latest.get(place))),
        )
        for place, names in directions.items()
    ]
    return DiagnosticArray(header=header, status=status)


def _words(counter: Counter, place: str, directions: tuple[str, str]) -> str:
    counts = ", ".join(f"{name} {counter.count(place, name)}" for name in directions)
    there = counter.occupancy.get(place)
    return counts if there is None else f"{there} inside, {counts}"


def _values(
    counter: Counter, place: str, directions: tuple[str, str], last: Crossing | None
) -> dict[str, object]:
    values: dict[str, object] = {name: counter.count(place, name) for name in directions}
    for (at, direction, label), number in sorted(counter.totals.items()):
        if at == place and label:
            values[f"{direction} {label}"] = number
    if place in counter.occupancy:
        values["occupancy"] = counter.occupancy[place]
    if last is not None:
        values["last id"], values["last direction"] = last.identity, last.direction
        values["last stamp (ns)"] = last.stamp_ns
        speeds = {"last speed (px/s)": last.speed_px, "last speed (km/h)": last.speed_kmh}
        values |= {name: speed for name, speed in speeds.items() if speed is not None}
    return values
