"""Scenes in which nothing is left to choose but the seed: rows of tables after the papers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.scenes.drive import Drive, DriveParameters
from vehicle_pf_tracker.scenes.randomness import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene

Build: TypeAlias = Callable[[DriveParameters, int], Scene]
"""Makes a scene from the choices for a drive and a seed."""


@dataclass(frozen=True, slots=True)
class NoParameters:
    """Nothing can be chosen but the seed."""


@dataclass(frozen=True, slots=True)
class FixedScene:
    """A row of a table.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    occlusion : {"partial and total", "total", "partial", "none"}
        How the vehicle is hidden. Every total occlusion begins and ends partial; "partial" stands
        for one of its own.
    what : str
        What happens.
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
        return f"{self.what}: {chosen.vehicle}, {chosen.resolution}, occlusion {self.occlusion}"

    def scene(self, parameters: NoParameters, seed: int) -> Scene:
        """Make the scene; rows of one seed differ in vehicle, traffic and ground."""
        own = int(stream(seed, self.name).integers(2**32))
        return replace(self.build(self.parameters, own), name=self.name)


def past(*obstacles: Callable[[Drive], list[Actor]]) -> Build:
    """Drive past `obstacles`, the farthest first, among other traffic."""

    def build(parameters: DriveParameters, seed: int) -> Scene:
        drive = Drive(parameters, seed)
        front = [actor for obstacle in obstacles for actor in obstacle(drive)]
        return drive.scene("", front)

    return build


def chosen(kind: str, speed: float, heading: str, others: Mapping[str, str]) -> DriveParameters:
    """Choose the vehicle, its speed (px/frame), where it heads, and `others` by name."""
    values = {"vehicle": kind, "speed": speed, "heading": heading, **others}
    return from_mapping(DriveParameters, values)
