# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command line of the scenes: ``python -m laboratory.scenes SCENE OUT``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from laboratory.scenes import LABORATORY_SCENES, TRAFFIC_SCENES, make_scene, make_traffic_scene
from laboratory.scenes.conditions import CONDITIONS
from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.scenes.simulated_detector import SIMULATED_DETECTORS
from laboratory.scenes.traffic_close import BRIEF, CloseScene
from laboratory.scenes.traffic_perspective import PerspectiveScene, road_file
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.synth import record_scene


def main() -> int:
    """Write a scene as a recording, or traffic as a folder in MOTChallenge's layout."""
    parser = argparse.ArgumentParser(prog="python -m laboratory.scenes", description=main.__doc__)
    scenes = (*LABORATORY_SCENES, *TRAFFIC_SCENES)
    parser.add_argument("scene", metavar="SCENE", choices=scenes, help=", ".join(scenes))
    parser.add_argument("out", metavar="OUT", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seen", choices=CONDITIONS, help="of traffic: weather or light")
    parser.add_argument("--every", type=int, default=1, help="of traffic: keep each k-th frame")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    args = parser.parse_args()
    if args.scene in LABORATORY_SCENES:
        record_scene(make_scene(args.scene, seed=args.seed, settings=args.set), args.out)
    else:
        scene = make_traffic_scene(args.scene, seed=args.seed, settings=args.set)
        # Only a close road has the blur and the short visits that `brief` stands for.
        more = {"brief": BRIEF} if isinstance(scene, CloseScene) else {}
        make = CONDITIONS[args.seen] if args.seen else None
        write_mot_folder(
            scene,
            args.out,
            args.seed,
            detectors={**SIMULATED_DETECTORS, **more},
            condition=make((scene.width, scene.height), args.seed) if make else None,
            every=max(args.every, 1),
        )
        if isinstance(scene, PerspectiveScene):
            (args.out / "road.yaml").write_text(road_file(scene), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.scenes"))
