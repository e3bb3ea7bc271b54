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

"""The scenes by name, with one target or with many vehicles, and how to make one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeAlias, TypeVar

from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import from_mapping, parse_assignments, specs
from vehicle_pf_tracker.scenes import drives
from vehicle_pf_tracker.scenes.compositing import check_seed
from vehicle_pf_tracker.scenes.drive import DriveParameters, HighwayParameters, highway
from vehicle_pf_tracker.scenes.drives import BarParameters, BrakingParameters, HidingParameters
from vehicle_pf_tracker.scenes.flow import TrafficSceneParameters
from vehicle_pf_tracker.scenes.scene import Scene
from vehicle_pf_tracker.scenes.traffic_scene import TrafficScene, traffic

SceneT = TypeVar("SceneT")


@dataclass(frozen=True, slots=True)
class SceneKind(Generic[SceneT]):
    """An entry of the catalogue.

    Attributes
    ----------
    parameters : type
        Frozen dataclass of the scene's parameters, its fields made with `parameter`.
    build : callable
        Makes the scene from an instance of `parameters` and a seed.
    summary : str
        Content of the scene, in one line.
    settings : mapping of str to object
        Parameters that differ from the defaults of `parameters`.
    """

    parameters: type[Any]
    build: Callable[[Any, int], SceneT]
    summary: str
    settings: Mapping[str, object] = field(default_factory=dict)


SCENES: dict[str, SceneKind[Scene]] = {
    "bar": SceneKind(BarParameters, drives.bar, "a vehicle passes behind a dark vertical bar"),
    "highway": SceneKind(
        HighwayParameters, highway, "traffic; a bridge, then a lorry that overtakes hide the target"
    ),
    "bars": SceneKind(
        DriveParameters, drives.bars, "four pillars of rising width in front of the road"
    ),
    "bridge": SceneKind(HidingParameters, drives.bridge, "a bridge hides the target"),
    "signs": SceneKind(
        HidingParameters, drives.signs, "lamp posts, and a large sign hides the target"
    ),
    "trees": SceneKind(
        DriveParameters, drives.trees, "thin crowns of trees hide parts of the target"
    ),
    "bus": SceneKind(HidingParameters, drives.bus, "a coach overtakes and hides the target"),
    "twin": SceneKind(
        DriveParameters, drives.twin, "a vehicle of the same appearance drives alongside"
    ),
    "clear": SceneKind(DriveParameters, drives.clear, "nothing in the way of the target"),
    "braking": SceneKind(BrakingParameters, drives.braking, "the speed changes under a bridge"),
    "turn": SceneKind(DriveParameters, drives.turn, "the target turns into a side road"),
    "turn_occluded": SceneKind(DriveParameters, drives.turn_occluded, "it turns behind a house"),
}
"""The scenes with one target, by name."""


def _traffic(summary: str, **settings: object) -> SceneKind[TrafficScene]:
    return SceneKind(TrafficSceneParameters, traffic, summary, settings)


TRAFFIC_SCENES: dict[str, SceneKind[TrafficScene]] = {
    "traffic-pair": _traffic(
        "a car overtakes behind a lorry, which hides it",
        vehicles=2, directions=1, lanes=2, lorries=0.5, frames=240,
    ),
    "traffic-lanes": _traffic(
        "twenty vehicles; the fast ones change lanes",
        vehicles=20, changing=True, gap=14.0, lorries=0.2, frames=350,
    ),
    "traffic-queue": _traffic(
        "all wait at a red light, and go on", vehicles=24, lorries=0.0, flow="queue", frames=540
    ),
    "traffic-waves": _traffic("stop and go", vehicles=30, flow="waves", gap=12.0, frames=600),
    "traffic-lorries": _traffic(
        "lorries hide several cars at once",
        vehicles=24, lanes=2, lorries=0.25, gap=12.0, frames=500,
    ),
    "traffic-bridge": _traffic(
        "a bridge hides every vehicle once", vehicles=16, bridges=1, bridge_width=90.0
    ),
    "traffic-forty": _traffic(
        "forty vehicles, about 180 total occlusions",
        vehicles=40, bridges=5, bridge_width=58.0, lorries=0.05, frames=650,
    ),
    "traffic-eighty": _traffic(
        "eighty vehicles in eight lanes",
        vehicles=80, lanes=4, gap=9.0, changing=True, flow="waves", frames=600,
    ),
}  # fmt: skip
"""The scenes with many vehicles, by name."""


Settings: TypeAlias = Mapping[str, object] | Sequence[str]
"""Parameters of a scene by name, or ``key=value`` words."""


def make_scene(
    name: str,
    *,
    seed: int = 0,
    settings: Settings = (),
    scenes: Mapping[str, SceneKind[Scene]] = SCENES,
) -> Scene:
    """Make the scene `name`.

    Parameters
    ----------
    name : str
        A key of `scenes`.
    seed : int
        Integer >= 0: changes textures, noise and all that is random in the scene.
    settings : mapping or sequence of str
        Scene parameters by name, or ``key=value`` words.
    scenes : mapping of str to SceneKind
        The scenes to choose from.

    Raises
    ------
    InputError
        If the scene or a setting is unknown (naming the known ones), or a value does not fit.
    """
    return _make(scenes, name, seed, settings)


def make_traffic_scene(
    name: str,
    *,
    seed: int = 0,
    settings: Settings = (),
    scenes: Mapping[str, SceneKind[TrafficScene]] = TRAFFIC_SCENES,
) -> TrafficScene:
    """Make the scene `name` with many vehicles; see `make_scene`."""
    return _make(scenes, name, seed, settings)


def _make(
    scenes: Mapping[str, SceneKind[SceneT]], name: str, seed: int, settings: Settings
) -> SceneT:
    if name not in scenes:
        raise InputError(
            f"there is no scene {name!r}{suggestion(name, scenes)}; choose one of "
            f"{', '.join(scenes)}"
        )
    kind = scenes[name]
    known = specs(kind.parameters)
    unknown = [key for word in settings if (key := word.partition("=")[0]) not in known]
    if unknown:
        raise InputError(
            f"the scene {name} has no setting {', '.join(map(repr, unknown))}"
            f"{suggestion(unknown[0], known)}; "
            f"it has {', '.join(known) or 'none'}"
        )
    values = settings if isinstance(settings, Mapping) else parse_assignments(known, settings)
    parameters = from_mapping(kind.parameters, {**kind.settings, **values})
    return kind.build(parameters, check_seed(seed))
