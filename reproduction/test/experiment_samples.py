# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells on a scene of 15 frames."""

from dataclasses import dataclass

from reproduction.runs.cells import RunCell, SceneChoice, System

SCENE = SceneChoice.of("bar", {"speed": 38.0, "width": 0.0})
PF = System.of("PF", "pf", {"num_particles": 20, "sigma": 30.0})


def run_cells(seeds=range(3), scenes=(0, 1), system=PF, record=("x", "pi")):
    return [
        RunCell(SCENE.seeded(scene), system, seed, record) for scene in scenes for seed in seeds
    ]


@dataclass(frozen=True)
class CountingCell:
    """Its result is how many frames it was shown; `alone` can be chosen."""

    name: str
    scene: SceneChoice = SCENE
    alone: bool = False
    variants: tuple[str, ...] = ()

    @property
    def label(self):
        return self.name

    def facts(self):
        return {"name": self.name, "scene": repr(self.scene)}

    def start(self):
        return _Counter()


class _Counter:
    def __init__(self):
        self.frames = 0

    def feed(self, shown):
        self.frames += 1

    def result(self):
        return {"frames": self.frames}
