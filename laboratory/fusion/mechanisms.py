# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contribution of what `fusion` has before standing cameras: each mechanism off, over five seeds.

    python -m laboratory.fusion.mechanisms SEQUENCES --kinds plain,wall -o results/fusion_mechanisms

`laboratory.fusion.ablation` changes parameters. These mechanisms have none, so that a function or
a bound of theirs is replaced while the tracker runs. The table has the same columns, with 95 %
bootstrap intervals over cameras. Only sequences of standing cameras say anything.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from laboratory.fusion.ablation import DEFAULT, compare
from laboratory.fusion.case_lists import listed_cases
from laboratory.fusion.options import make_parser, parsed
from laboratory.stress import StressSystem, variant_system
from laboratory.stress.systems import Follower
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion import exclusion, hidden_way, observe, turning
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.sides import Sides
from vehicle_pf_tracker.trackers.fusion.turning import Branch

FRAMES = 200
"""Frames of a case at most, a choice: what hides the vehicle is passed by then."""


class Replacement(NamedTuple):
    """A name of a module or class, and what it is without a mechanism."""

    owner: Any
    name: str
    value: Any


def _nowhere(positions: Array, *_motion: object) -> Array:
    """Exclude no position."""
    return np.zeros(positions.shape[:-1], np.bool_)


def _always(value: object) -> Any:
    """Give the same for any arguments."""
    return lambda *_arguments, **_named: value


# One mechanism a row; the words are those of docs/fusion.md.
MECHANISMS: Mapping[str, tuple[Replacement, ...]] = {
    DEFAULT: (),
    "returns far ahead": (Replacement(hidden_way, "_EARLY", np.inf),),
    "returns behind": (Replacement(hidden_way, "is_behind", _nowhere),),
    "returns in another paint": (Replacement(exclusion, "_LEAST_PAINT", -1.0),),
    "hypotheses drawn to what stands": (Replacement(observe, "is_covered", _always(False)),),
    "turns in another paint": (Replacement(turning, "_OTHER_PAINT", np.inf),),
    "turns behind the path": (Replacement(turning, "BEHIND", np.inf),),
    "no outline in a turn": (Replacement(Branch, "begun", classmethod(_always(None))),),
    "nothing comes out beside the path": (Replacement(Emergence, "was_alone", _always(False)),),
    "no flank": (Replacement(Sides, "unfolded", _always(None)),),
}

WHOLE = tuple(
    Replacement(one.owner, one.name, vars(one.owner)[one.name])
    for each in MECHANISMS.values()
    for one in each
)
"""All that is replaced, as it is in the tracker."""


def made_without(name: str, seed: int) -> Follower:
    """Make a tracker without a mechanism; until the next one is made, others are without it, too.

    Each process runs one case at a time.
    """
    for one in (*WHOLE, *MECHANISMS[name]):
        setattr(one.owner, one.name, one.value)
    return variant_system("fusion").make(seed)


def system_without(name: str) -> StressSystem:
    """Make the system without a mechanism, by its name in `MECHANISMS`."""
    whole = variant_system("fusion", {}, name)
    facts = {**whole.facts, "without": name}
    return StressSystem(name, functools.partial(made_without, name), facts, whole.modules)


def main() -> int:
    """Run all systems over all cases."""
    parser = make_parser(__doc__, "seeds")
    parser.add_argument("--kinds", default="plain,wall", help="kinds of cases, by commas")
    parser.add_argument("--cases", type=int, help="cases of a kind and a sequence at most")
    parser.add_argument("--without", nargs="+", default=list(MECHANISMS), choices=list(MECHANISMS))
    options = parsed(parser)
    # The default always runs: everything is compared with it.
    systems = [system_without(name) for name in dict.fromkeys([DEFAULT, *options.without])]
    limits = {"max_frames": FRAMES}
    if options.cases:
        limits["per_sequence"] = options.cases
    cases = [
        case
        for kind in options.kinds.split(",")
        for case in listed_cases(options, f"mechanisms_{kind}", (kind,), **limits)
    ]
    compare(
        "mechanisms", cases, systems, range(options.seed, options.seed + options.seeds), options
    )
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.mechanisms"))
