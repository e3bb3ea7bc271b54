"""Twenty scenes like the twenty videos of the APF paper.

Source: Scharcanski et al. 2011, table I (vehicle, occlusion, resolution) and figure 5 (in its
video 3 signs, then a bus hide the vehicle). What hides each of the others, and how fast they are,
the paper does not say.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from vehicle_pf_tracker.scenes.drive import Drive, DriveParameters
from vehicle_pf_tracker.scenes.manoeuvres import clear, turning
from vehicle_pf_tracker.scenes.moving_obstacles import (
    coach_at,
    cross,
    dense,
    near_traffic,
    van_at,
)
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.standing_obstacles import (
    bridge_at,
    pillar_at,
    posts_at,
    sign_at,
    trees_at,
)
from vehicle_pf_tracker.trackers.parameters import from_mapping

Build = Callable[[DriveParameters, int], Scene]


@dataclass(frozen=True, slots=True)
class NoParameters:
    """Nothing can be chosen but the seed."""


@dataclass(frozen=True, slots=True)
class Video:
    """A row of the table.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    occlusion : {"partial and total", "total", "partial", "none"}
        What the paper says about its video. Every total occlusion begins and ends partial.
    what : str
        What hides the vehicle.
    parameters : DriveParameters
        The vehicle, the image and the road.
    build : callable
        Makes a scene from such parameters and a seed.
    """

    name: str
    occlusion: str
    what: str
    parameters: DriveParameters
    build: Build

    @property
    def summary(self) -> str:
        """The row in one line."""
        chosen = self.parameters
        return f"{chosen.vehicle}, {chosen.resolution}, occlusion: {self.occlusion} ({self.what})"

    def scene(self, parameters: NoParameters, seed: int) -> Scene:
        """Make the scene."""
        return replace(self.build(self.parameters, seed), name=self.name)


def _past(*obstacles: Callable[[Drive], list[Actor]]) -> Build:
    """Drive past `obstacles`."""

    def build(parameters: DriveParameters, seed: int) -> Scene:
        drive = Drive(parameters, seed)
        front = [actor for obstacle in obstacles for actor in obstacle(drive)]
        return drive.scene("", [*drive.opposite_traffic(), *front], behind=drive.far_traffic())

    return build


def _turn_past_trees(parameters: DriveParameters, seed: int) -> Scene:
    drive = turning(parameters, seed)
    return drive.scene("", trees_at(drive, (0.2, 0.36)), behind=())


def _chosen(kind: str, speed: float, heading: str, **others: str) -> DriveParameters:
    values = {"vehicle": kind, "speed": speed, "heading": heading, **others}
    return from_mapping(DriveParameters, values)


_LARGE = {"resolution": "768x576"}
_TOWN = {"surroundings": "town"}
_ROUGH = {"disturbance": "rough"}

_BOTH, _TOTAL, _PARTIAL = "partial and total", "total", "partial"

_TABLE = (
    Video("video01", _BOTH, "a tree, a bridge", _chosen("suv", 4.5, "right"),
          _past(lambda d: trees_at(d, (0.23,)), lambda d: bridge_at(d, 0.55, 14))),
    Video("video02", _BOTH, "a lamp post, a coach", _chosen("car", 4.5, "left", **_ROUGH),
          _past(lambda d: coach_at(d, 0.5, 16), lambda d: posts_at(d, (0.18,), 14))),
    Video("video03", _BOTH, "a lamp post, a sign, a coach", _chosen("suv", 4.0, "right"),
          _past(lambda d: coach_at(d, 0.68, 10), lambda d: posts_at(d, (0.15,), 12),
                lambda d: sign_at(d, 0.34, 8))),
    Video("video04", _TOTAL, "a bridge", _chosen("car", 6.0, "left"),
          _past(lambda d: bridge_at(d, 0.45, 18))),
    Video("video05", _TOTAL, "a bridge", _chosen("truck", 4.0, "right", **_ROUGH),
          _past(lambda d: bridge_at(d, 0.45, 14))),
    Video("video06", _TOTAL, "a sign", _chosen("truck", 4.5, "left"),
          _past(lambda d: sign_at(d, 0.45, 8))),
    Video("video07", _TOTAL, "a pillar", _chosen("truck", 5.0, "right", **_TOWN),
          _past(lambda d: pillar_at(d, 0.45, 6))),
    Video("video08", _TOTAL, "a coach", _chosen("car", 5.0, "right", **_TOWN),
          _past(lambda d: coach_at(d, 0.45, 14))),
    Video("video09", _TOTAL, "a coach that crosses", _chosen("car", 5.0, "left"), cross),
    Video("video10", _TOTAL, "a sign", _chosen("car", 7.0, "left", **_ROUGH),
          _past(lambda d: sign_at(d, 0.45, 10))),
    Video("video11", _TOTAL, "a bridge", _chosen("truck", 5.5, "left"),
          _past(lambda d: bridge_at(d, 0.42, 16))),
    Video("video12", _PARTIAL, "trees", _chosen("car", 5.0, "right", **_LARGE, **_TOWN),
          _past(lambda d: trees_at(d, (0.25, 0.5, 0.74)))),
    Video("video13", _PARTIAL, "dense traffic", _chosen("car", 5.5, "left", **_LARGE), dense),
    Video("video14", _PARTIAL, "lamp posts",
          _chosen("car", 6.0, "left", **_LARGE, **_TOWN, **_ROUGH),
          _past(lambda d: posts_at(d, (0.22, 0.42, 0.62, 0.82), 15))),
    Video("video15", _PARTIAL, "a van that it overtakes", _chosen("car", 6.5, "right", **_LARGE),
          _past(lambda d: van_at(d, 0.5, 40))),
    Video("video16", _PARTIAL, "trees before a turn",
          _chosen("car", 5.0, "right", **_TOWN, **_LARGE),
          _turn_past_trees),
    Video("video17", _PARTIAL, "a van and a lamp post",
          _chosen("car", 5.0, "left", **_LARGE, **_ROUGH),
          _past(lambda d: van_at(d, 0.4, 30), lambda d: posts_at(d, (0.72,), 15))),
    Video("video18", _PARTIAL, "faster traffic", _chosen("car", 5.0, "right", **_LARGE),
          _past(near_traffic)),
    Video("video19", "none", "nothing", _chosen("car", 5.0, "left"), clear),
    Video("video20", "none", "nothing", _chosen("car", 6.0, "right", **_TOWN, **_ROUGH), clear),
)  # fmt: skip

VIDEOS: dict[str, Video] = {video.name: video for video in _TABLE}
"""The table by name."""
