"""Twenty scenes like the twenty videos of the APF paper.

Source: Scharcanski et al. 2011, table I (vehicle, occlusion, resolution) and figure 5 (in its
video 3 signs, then a bus hide the vehicle). What hides each of the others, and how fast they are,
the paper does not say.
"""

from __future__ import annotations

from reproduction.scenes.fixed_scenes import FixedScene, chosen, past
from vehicle_pf_tracker.scenes.drive import DriveParameters
from vehicle_pf_tracker.scenes.manoeuvres import clear, turning
from vehicle_pf_tracker.scenes.occluded_drives import (
    bridge_at,
    coach_at,
    cross,
    dense,
    near_traffic,
    pillar_at,
    posts_at,
    sign_at,
    trees_at,
    van_at,
)
from vehicle_pf_tracker.scenes.scene import Scene


def _turn_past_trees(parameters: DriveParameters, seed: int) -> Scene:
    drive = turning(parameters, seed)
    return drive.scene("", trees_at(drive, (0.2, 0.36)), behind=())


_LARGE = {"resolution": "768x576"}
_TOWN = {"surroundings": "town"}
_ROUGH = {"disturbance": "rough"}

_BOTH, _TOTAL, _PARTIAL = "partial and total", "total", "partial"

_TABLE = (
    FixedScene("video01", _BOTH, "a tree, a bridge", chosen("suv", 4.5, "right", {}),
               past(lambda d: trees_at(d, (0.23,)), lambda d: bridge_at(d, 0.55, 14))),
    FixedScene("video02", _BOTH, "a lamp post, a coach", chosen("car", 4.5, "left", _ROUGH),
               past(lambda d: coach_at(d, 0.5, 16), lambda d: posts_at(d, (0.18,), 14))),
    FixedScene("video03", _BOTH, "a lamp post, a sign, a coach", chosen("suv", 4.0, "right", {}),
               past(lambda d: coach_at(d, 0.68, 10), lambda d: posts_at(d, (0.15,), 12),
                    lambda d: sign_at(d, 0.34, 8))),
    FixedScene("video04", _TOTAL, "a bridge", chosen("car", 6.0, "left", {}),
               past(lambda d: bridge_at(d, 0.45, 18))),
    FixedScene("video05", _TOTAL, "a bridge", chosen("truck", 4.0, "right", _ROUGH),
               past(lambda d: bridge_at(d, 0.45, 14))),
    FixedScene("video06", _TOTAL, "a sign", chosen("truck", 4.5, "left", {}),
               past(lambda d: sign_at(d, 0.45, 8))),
    FixedScene("video07", _TOTAL, "a pillar", chosen("truck", 5.0, "right", _TOWN),
               past(lambda d: pillar_at(d, 0.45, 6))),
    FixedScene("video08", _TOTAL, "a coach", chosen("car", 5.0, "right", _TOWN),
               past(lambda d: coach_at(d, 0.45, 14))),
    FixedScene("video09", _TOTAL, "a coach that crosses", chosen("car", 5.0, "left", {}), cross),
    FixedScene("video10", _TOTAL, "a sign", chosen("car", 7.0, "left", _ROUGH),
               past(lambda d: sign_at(d, 0.45, 10))),
    FixedScene("video11", _TOTAL, "a bridge", chosen("truck", 5.5, "left", {}),
               past(lambda d: bridge_at(d, 0.42, 16))),
    FixedScene("video12", _PARTIAL, "trees", chosen("car", 5.0, "right", {**_LARGE, **_TOWN}),
               past(lambda d: trees_at(d, (0.25, 0.5, 0.74)))),
    FixedScene("video13", _PARTIAL, "dense traffic", chosen("car", 5.5, "left", _LARGE), dense),
    FixedScene("video14", _PARTIAL, "lamp posts",
               chosen("car", 6.0, "left", {**_LARGE, **_TOWN, **_ROUGH}),
               past(lambda d: posts_at(d, (0.22, 0.42, 0.62, 0.82), 15))),
    FixedScene("video15", _PARTIAL, "a van that it overtakes",
               chosen("car", 6.5, "right", _LARGE),
               past(lambda d: van_at(d, 0.5, 40))),
    FixedScene("video16", _PARTIAL, "trees before a turn",
               chosen("car", 5.0, "right", {**_TOWN, **_LARGE}),
               _turn_past_trees),
    FixedScene("video17", _PARTIAL, "a van and a lamp post",
               chosen("car", 5.0, "left", {**_LARGE, **_ROUGH}),
               past(lambda d: van_at(d, 0.4, 30), lambda d: posts_at(d, (0.72,), 15))),
    FixedScene("video18", _PARTIAL, "faster traffic", chosen("car", 5.0, "right", _LARGE),
               past(near_traffic)),
    FixedScene("video19", "none", "nothing", chosen("car", 5.0, "left", {}), clear),
    FixedScene("video20", "none", "nothing",
               chosen("car", 6.0, "right", {**_TOWN, **_ROUGH}), clear),
)  # fmt: skip

VIDEOS: dict[str, FixedScene] = {video.name: video for video in _TABLE}
"""The table by name."""
