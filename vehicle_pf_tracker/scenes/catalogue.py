# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The scenes by name, and how to make one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeAlias, TypeVar

from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import from_mapping, parse_assignments, specs
from vehicle_pf_tracker.scenes import drive_scenes
from vehicle_pf_tracker.scenes.bar import BarParameters, bar
from vehicle_pf_tracker.scenes.drive import DriveParameters
from vehicle_pf_tracker.scenes.drive_scenes import BrakingParameters, HidingParameters
from vehicle_pf_tracker.scenes.highway import HighwayParameters, highway
from vehicle_pf_tracker.scenes.scene import Scene

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
    "bar": SceneKind(BarParameters, bar, "a vehicle passes behind a dark vertical bar"),
    "highway": SceneKind(
        HighwayParameters, highway, "traffic; a bridge, then a lorry that overtakes hide the target"
    ),
    "bars": SceneKind(
        DriveParameters, drive_scenes.bars, "four pillars of rising width in front of the road"
    ),
    "bridge": SceneKind(HidingParameters, drive_scenes.bridge, "a bridge hides the target"),
    "trees": SceneKind(
        DriveParameters, drive_scenes.trees, "thin crowns of trees hide parts of the target"
    ),
    "bus": SceneKind(HidingParameters, drive_scenes.bus, "a coach overtakes and hides the target"),
    "twin": SceneKind(
        DriveParameters, drive_scenes.twin, "a vehicle of the same appearance drives alongside"
    ),
    "clear": SceneKind(DriveParameters, drive_scenes.clear, "nothing in the way of the target"),
    "braking": SceneKind(
        BrakingParameters, drive_scenes.braking, "the speed changes under a bridge"
    ),
}
"""The scenes by name."""


Settings: TypeAlias = Mapping[str, object] | Sequence[str]
"""Parameters of a scene by name, or ``key=value`` words."""


def make_scene(name: str, *, seed: int = 0, settings: Settings = ()) -> Scene:
    """Make the scene `name` of `SCENES`; see `scene_of`."""
    return scene_of(SCENES, name, seed=seed, settings=settings)


def scene_of(
    scenes: Mapping[str, SceneKind[SceneT]], name: str, *, seed: int = 0, settings: Settings = ()
) -> SceneT:
    """Make the scene `name` of a catalogue.

    Parameters
    ----------
    scenes : mapping of str to SceneKind
        The scenes to choose from.
    name : str
        A key of `scenes`.
    seed : int
        Integer >= 0: changes textures, noise and all that is random in the scene.
    settings : mapping or sequence of str
        Scene parameters by name, or ``key=value`` words.

    Raises
    ------
    InputError
        If the scene or a setting is unknown (naming the known ones), or a value or the seed does
        not fit.
    """
    if name not in scenes:
        raise InputError(
            f"there is no scene {name!r}{suggestion(name, scenes)}; choose one of "
            f"{', '.join(scenes)}"
        )
    # numpy refuses negative seeds with a ValueError that names neither scene nor option.
    if seed < 0:
        raise InputError(f"the seed of a scene must be an integer >= 0, got {seed}")
    kind = scenes[name]
    known = specs(kind.parameters)
    # Before the values are parsed: the table of parameters does not know the scene's name.
    for key in (word.partition("=")[0] for word in settings):
        if key not in known:
            meant = suggestion(key, known)
            has = ", ".join(known) or "none"
            raise InputError(f"the scene {name} has no setting {key!r}{meant}; it has {has}")
    if not isinstance(settings, Mapping):
        settings = parse_assignments(known, settings)
    # The caller's settings last: they take the place of those of the catalogue.
    return kind.build(from_mapping(kind.parameters, {**kind.settings, **settings}), seed)
