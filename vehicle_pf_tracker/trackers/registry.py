# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Registry of the tracker variants, one entry each: the only list of them.

Executables (through setup.py), parameter files, SROS 2 enclaves and the tables in the documentation
are derived from these entries by `make config`. A tracker is imported when its class is first asked
for, so that a node loads its own variant only; setup.py reads this file where neither numpy nor
OpenCV is installed. Other distributions add variants as entry points, see `plug_ins`.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, is_dataclass
from functools import cache
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

from vehicle_pf_tracker.core.errors import InputError, suggestion

if TYPE_CHECKING:
    from vehicle_pf_tracker.trackers.base import BaseTracker

_PACKAGE = __name__.rpartition(".")[0]
"""Package that modules with a leading dot lie in."""


@dataclass(frozen=True, slots=True)
class Variant:
    """A registered tracker.

    Attributes
    ----------
    name : str
        Name that users type.
    classes : str
        ``module:Prefix``: the module that contains ``PrefixTracker`` and ``PrefixParameters``; with
        a leading dot it lies below `trackers`.
    summary : str
        Method and source, in one line.
    suits : str
        Situation to choose it in, in one line.
    """

    name: str
    classes: str
    summary: str
    suits: str

    @property
    def executable(self) -> str:
        """Name of its node and of the program that runs it."""
        return f"{self.name}_tracker"

    @property
    def is_plug_in(self) -> bool:
        """True if another distribution has it."""
        return not self.classes.startswith(".")

    @property
    def tracker(self) -> type[BaseTracker[Any]]:
        """Tracker class, imported now."""
        return cast("type[BaseTracker[Any]]", self._load("Tracker"))

    @property
    def parameters(self) -> type[Any]:
        """Parameter dataclass, all of whose fields have defaults; imported now."""
        parameters = cast("type[Any]", self._load("Parameters"))
        if not is_dataclass(parameters):
            raise InputError(
                f"{self.name}, a {self.summary}, cannot be used: its {parameters.__name__} is not "
                "a dataclass; derive it from CommonParameters and decorate it with "
                "@dataclass(frozen=True, slots=True)"
            )
        return parameters

    def _load(self, role: str) -> object:
        module, _, prefix = self.classes.partition(":")
        try:
            return getattr(import_module(module, _PACKAGE), prefix + role)
        except Exception as error:
            # Our own import errors are bugs and keep their traceback.
            if not self.is_plug_in:
                raise
            raise InputError(f"{self.name}, a {self.summary}, cannot be loaded: {error}") from error


_ENTRIES = (
    Variant(
        "apf", ".papers.apf:Apf", "adaptive particle filter, two regimes (Scharcanski et al. 2011)",
        "short occlusions on a straight road, where the vehicle's colours are distinctive",
    ),
    Variant(
        "pf", ".papers.pf:Pf", "colour particle filter (Perez et al. 2002)",
        "a vehicle in plain view whose colours differ from the road's",
    ),
    Variant(
        "sapf", ".papers.sapf:Sapf", "annealed particle filter (Deutscher et al. 2000)",
        "as `pf`, where the vehicle moves far between two frames",
    ),
    Variant(
        "hpfms", ".papers.hpfms:Hpfms",
        "few particles refined by mean shift (Maggio and Cavallaro 2005)",
        "as `pf`, where there is little time per frame",
    ),
    Variant(
        "pfcl", ".papers.pfcl:Pfcl", "colour and straight lines (Xiong and Debrunner 2004)",
        "a vehicle with straight edges among others of its colours",
    ),
    Variant(
        "ms", ".papers.ms:Ms", "mean shift, without particles (Comaniciu et al. 2003)",
        "a fixed camera, no occlusions, and the least time per frame",
    ),
    Variant(
        "mfpf", ".papers.mfpf:Mfpf",
        "colour, edges and texture with adaptive weights (Abdulla et al. 2022)",
        "a vehicle whose edges or texture are more distinctive than its colours",
    ),
    Variant(
        "sfpf_color", ".papers.sfpf:SfpfColor", "colour alone (Abdulla et al. 2022)",
        "comparison with `mfpf`",
    ),
    Variant(
        "sfpf_edge", ".papers.sfpf:SfpfEdge", "edge directions alone (Abdulla et al. 2022)",
        "comparison with `mfpf`; grey video",
    ),
    Variant(
        "sfpf_texture", ".papers.sfpf:SfpfTexture", "texture alone (Abdulla et al. 2022)",
        "comparison with `mfpf`, which it comes closest to; grey video",
    ),
    Variant(
        "conventional", ".papers.repeated_resampling:Conventional",
        "colour, all particles resampled until enough count (Khong et al.)",
        "comparison with `adaptive`, or of resampling schemes",
    ),
    Variant(
        "adaptive", ".papers.repeated_resampling:Adaptive",
        "colour, only low weights resampled until enough count (Khong et al.)",
        "as `conventional`, with fewer measurements per frame",
    ),
    Variant(
        "fusion", ".fusion.tracker:Fusion",
        "correlation particle filter with a posterior over visibility (this package)",
        "real video: changing size, a moving camera, total occlusions",
    ),
)  # fmt: skip

VARIANTS: Mapping[str, Variant] = MappingProxyType({entry.name: entry for entry in _ENTRIES})
"""Every variant by name."""

TRAFFIC_VARIANT = Variant(
    "traffic",
    ".traffic.tracker:Traffic",
    "every vehicle in view, with identities (this package)",
    "many vehicles at once, counts at lines and in zones",
)
"""Tracker of many vehicles. It has parameters and a node as variants do, but takes no target and
gives no `Estimate`, so that what runs variants cannot run it."""

NODES: Mapping[str, Variant] = MappingProxyType({**VARIANTS, TRAFFIC_VARIANT.name: TRAFFIC_VARIANT})
"""Everything that has a node, by name."""


def find_variant(name: str, own: Mapping[str, Variant] = VARIANTS) -> Variant:
    """Look up a variant of this package, or of another one.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    # Plug-ins last: none has a name that is taken (`plug_ins`).
    known = {**own, **plug_ins()}
    if name not in known:
        hint = suggestion(name.removesuffix("_tracker"), known)
        raise InputError(f"there is no variant {name!r}{hint}; choose one of {', '.join(known)}")
    return known[name]


def find_node(name: str) -> Variant:
    """Look up a variant, or `TRAFFIC_VARIANT`.

    Raises
    ------
    InputError
        If there is no node of this name.
    """
    return find_variant(name, NODES)


PLUG_INS = "vehicle_pf_tracker.variants"
"""Group of the entry points; the value of one is ``module:PrefixTracker``."""


@cache
def plug_ins() -> Mapping[str, Variant]:
    """Find the variants of other distributions; none is imported.

    One whose name is taken, or cannot be that of a node, is left out with a warning.
    """
    from importlib.metadata import entry_points  # noqa: PLC0415 - 30 ms

    by_name: dict[str, Variant] = {}
    for point in entry_points(group=PLUG_INS):
        owner = f"plug-in of {point.dist.name} {point.dist.version}" if point.dist else "plug-in"
        # A name that is taken would decide by chance what users get.
        if point.name in NODES or point.name in by_name or not point.name.isidentifier():
            words = "%r, a %s, is left out: its name is taken, or is not of letters, digits and _"
            logging.getLogger(__name__).warning(words, point.name, owner)
            continue
        classes = point.value.removesuffix("Tracker")
        by_name[point.name] = Variant(point.name, classes, owner, "")
    return by_name


def make_tracker(variant: str = "fusion", **parameters: Any) -> BaseTracker[Any]:
    """Make a tracker for a Python program.

    Call `start(frame, box)` with the first image and `step(frame)` with each that follows; both
    return an `Estimate`. Images are (H, W, 3) arrays of RGB bytes.

    Parameters
    ----------
    variant : str
        Name in the registry.
    **parameters : Any
        Parameters that differ from the defaults, by the names that ``params`` lists; those with a
        dot as ``**{"motion.camera": False}``.

    Raises
    ------
    InputError
        If there is no such variant or parameter, or a value does not fit.
    """
    from vehicle_pf_tracker.parameters.table import from_mapping  # noqa: PLC0415 - needs libraries

    entry = find_variant(variant)
    return entry.tracker(from_mapping(entry.parameters, parameters))
