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

"""The scenes by name, and how to make one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import from_mapping, parse_assignments, specs
from vehicle_pf_tracker.scenes.bar import BarParameters, bar
from vehicle_pf_tracker.scenes.compositing import check_seed
from vehicle_pf_tracker.scenes.drive import DriveParameters, HighwayParameters, highway
from vehicle_pf_tracker.scenes.light import (
    IlluminationParameters,
    ShadowParameters,
    illumination,
    shadows,
)
from vehicle_pf_tracker.scenes.manoeuvres import (
    AccelerationParameters,
    BrakingParameters,
    ScaleParameters,
    acceleration,
    braking,
    clear,
    scale,
    turn,
    turn_occluded,
)
from vehicle_pf_tracker.scenes.occluded_drives import (
    HidingParameters,
    bars,
    bridge,
    bus,
    cross,
    dense,
    signs,
    trees,
    twin,
)
from vehicle_pf_tracker.scenes.road import RoadSceneParameters, road
from vehicle_pf_tracker.scenes.scene import Scene


@dataclass(frozen=True, slots=True)
class SceneKind:
    """An entry of the catalogue.

    Attributes
    ----------
    parameters : type
        Frozen dataclass of the scene's parameters, its fields made with `parameter`.
    build : callable
        Makes the scene from an instance of `parameters` and a seed.
    summary : str
        Content of the scene, in one line.
    """

    parameters: type[Any]
    build: Callable[[Any, int], Scene]
    summary: str


SCENES: dict[str, SceneKind] = {
    "bar": SceneKind(BarParameters, bar, "a vehicle passes behind a dark vertical bar"),
    "highway": SceneKind(
        HighwayParameters, highway, "traffic; a bridge, then a lorry that overtakes hide the target"
    ),
    "bars": SceneKind(DriveParameters, bars, "four pillars of rising width in front of the road"),
    "bridge": SceneKind(HidingParameters, bridge, "a bridge hides the target"),
    "signs": SceneKind(HidingParameters, signs, "lamp posts, and a large sign hides the target"),
    "trees": SceneKind(DriveParameters, trees, "thin crowns of trees hide parts of the target"),
    "bus": SceneKind(HidingParameters, bus, "a coach overtakes and hides the target"),
    "cross": SceneKind(DriveParameters, cross, "a coach crosses the road in front of the target"),
    "twin": SceneKind(DriveParameters, twin, "a vehicle of the same appearance drives alongside"),
    "dense": SceneKind(DriveParameters, dense, "full lanes; vehicles hide parts of the target"),
    "shadows": SceneKind(ShadowParameters, shadows, "strong shadows of trees across the road"),
    "illumination": SceneKind(IlluminationParameters, illumination, "a cloud passes"),
    "clear": SceneKind(DriveParameters, clear, "nothing in the way of the target"),
    "acceleration": SceneKind(AccelerationParameters, acceleration, "faster, and slower again"),
    "braking": SceneKind(BrakingParameters, braking, "the speed changes under a bridge"),
    "turn": SceneKind(DriveParameters, turn, "the target turns into a side road"),
    "turn_occluded": SceneKind(DriveParameters, turn_occluded, "it turns behind a house"),
    "scale": SceneKind(ScaleParameters, scale, "the target drives into depth and changes its size"),
    "road": SceneKind(RoadSceneParameters, road, "a road in perspective, at a speed in km/h"),
}
"""The scenes that come with the package, by name."""


def make_scene(
    name: str,
    *,
    seed: int = 0,
    settings: Mapping[str, object] | Sequence[str] = (),
    scenes: Mapping[str, SceneKind] = SCENES,
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
    if name not in scenes:
        raise InputError(
            f"there is no scene {name!r}{suggestion(name, scenes)}; choose one of "
            f"{', '.join(scenes)}"
        )
    kind = scenes[name]
    if isinstance(settings, Mapping):
        _check_names(name, kind, settings)
        values: Mapping[str, object] = settings
    else:
        _check_names(name, kind, (word.partition("=")[0] for word in settings))
        values = parse_assignments(specs(kind.parameters), settings)
    return kind.build(from_mapping(kind.parameters, values), check_seed(seed))


def _check_names(scene: str, kind: SceneKind, names: Iterable[str]) -> None:
    known = specs(kind.parameters)
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(
            f"the scene {scene} has no setting {', '.join(map(repr, unknown))}"
            f"{suggestion(unknown[0], known)}; "
            f"it has {', '.join(known) or 'none'}"
        )
