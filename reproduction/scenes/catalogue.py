"""The scenes that experiments choose from: the package's and those after the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reproduction.scenes.cases import CASES
from reproduction.scenes.fixed_scenes import FixedScene, NoParameters
from reproduction.scenes.videos import VIDEOS
from vehicle_pf_tracker.scenes import catalogue
from vehicle_pf_tracker.scenes.catalogue import SceneKind
from vehicle_pf_tracker.scenes.scene import Scene

FIXED_SCENES: dict[str, FixedScene] = VIDEOS | CASES
"""The scenes after the papers, by name."""
SCENES: dict[str, SceneKind] = catalogue.SCENES | {
    name: SceneKind(NoParameters, row.scene, row.summary) for name, row in FIXED_SCENES.items()
}


def make_scene(
    name: str, *, seed: int = 0, settings: Mapping[str, object] | Sequence[str] = ()
) -> Scene:
    """Make the scene `name`, as `vehicle_pf_tracker.scenes.catalogue.make_scene` does."""
    return catalogue.make_scene(name, seed=seed, settings=settings, scenes=SCENES)
