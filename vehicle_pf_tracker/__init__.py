# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Particle-filter vehicle tracking through occlusions, for ROS 2 and for recordings.

The names below are the public interface for Python programs; see the README's example. They are
imported when they are first used, so that nothing else waits for OpenCV.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # `as` makes them names of this package for type checkers
    from vehicle_pf_tracker.core.box import Box as Box
    from vehicle_pf_tracker.core.errors import InputError as InputError
    from vehicle_pf_tracker.following.library import Estimates as Estimates
    from vehicle_pf_tracker.following.library import track as track
    from vehicle_pf_tracker.following.traffic_library import TrafficTracker as TrafficTracker
    from vehicle_pf_tracker.recordings.source import open_source as open_source
    from vehicle_pf_tracker.results.traffic_tables import read_counts as read_counts
    from vehicle_pf_tracker.results.traffic_tables import read_tracks as read_tracks
    from vehicle_pf_tracker.results.traffic_tables import read_zones as read_zones
    from vehicle_pf_tracker.trackers.estimate import Estimate as Estimate
    from vehicle_pf_tracker.trackers.estimate import Mode as Mode
    from vehicle_pf_tracker.trackers.registry import make_tracker as make_tracker

__version__: str
_HOMES = {
    "Box": "core.box",
    "Estimate": "trackers.estimate",
    "Estimates": "following.library",
    "InputError": "core.errors",
    "Mode": "trackers.estimate",
    "TrafficTracker": "following.traffic_library",
    "make_tracker": "trackers.registry",
    "open_source": "recordings.source",
    "read_counts": "results.traffic_tables",
    "read_tracks": "results.traffic_tables",
    "read_zones": "results.traffic_tables",
    "track": "following.library",
}
"""Module of each public name."""
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    """Import a public name, or look up the version."""
    if name == "__version__":
        return import_module(f"{__name__}.core.version").installed_version()
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
