# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes with many vehicles as folders in MOTChallenge's layout, with simulated detectors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from laboratory.scenes.conditions import Condition
from laboratory.scenes.simulated_detector import SIMULATED_DETECTORS, SimulatedDetector
from laboratory.scenes.traffic_scene import TrafficScene, VehicleTruth
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import whole_folder
from vehicle_pf_tracker.image.formats.compressed_image import jpeg

LEAST_SIDE = 8.0
"""Sides of a box inside the image, px, below which a vehicle has no truth but is ignored."""
# By whom each vehicle is hidden: `hidden_by` is an id, `scene` or empty; `share` is its part.
OCCLUDERS_HEADER = "frame,id,depth,hidden_by,share"


def write_mot_folder(
    scene: TrafficScene,
    folder: Path,
    seed: int,
    progress: Callable[[int, int], None] = lambda number, total: None,
    detectors: Mapping[str, SimulatedDetector] = SIMULATED_DETECTORS,
    condition: Condition | None = None,
    every: int = 1,
) -> None:
    """Render `scene` with its truth and simulated detectors into `folder`.

    The folder appears when it is whole.

    Parameters
    ----------
    scene : TrafficScene
        Scene to render.
    folder : Path
        New or empty folder.
    seed : int
        Seed of the detectors.
    progress : callable
        Called with the number of frames done and of all.
    detectors : mapping of str to SimulatedDetector
        Detectors by name.
    condition : Condition or None
        Weather or light in which the scene is seen.
    every : int
        Only each of so many frames is kept, at as much lower a rate.

    Raises
    ------
    InputError
        If the folder is not empty, or cannot be written.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"{folder} is not empty; choose another folder")
        with whole_folder(folder) as partial:
            for name in ("img1", "gt", "det"):
                (partial / name).mkdir()
            truths = []
            for index, (frame, truth) in enumerate(scene.frames()):
                progress(index + 1, scene.frame_count)
                # All frames are rendered: the scene's random streams go by their number.
                if index % every:
                    continue
                truths.append(truth)
                picture = frame
                if condition is not None:
                    # Lamps shine where a vehicle drives to, which the next frame says.
                    after = scene.truth(min(index + 1, scene.frame_count - 1))
                    picture = condition(frame, index, truth, after)
                (partial / "img1" / f"{len(truths):06d}.jpg").write_bytes(jpeg(picture))
            name = folder.resolve().name
            (partial / "seqinfo.ini").write_text(_information(scene, name, every))
            _write_tables(scene, truths, partial, seed, detectors)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror}") from error


def _information(scene: TrafficScene, name: str, every: int) -> str:
    count = -(-scene.frame_count // every)  # rounded up: the first frame is always kept
    return (
        f"[Sequence]\nname={name}\nimDir=img1\nframeRate={scene.frame_rate / every:g}\n"
        f"seqLength={count}\nimWidth={scene.width}\nimHeight={scene.height}\n"
        "imExt=.jpg\n"
    )


def _write_tables(
    scene: TrafficScene,
    truths: Sequence[Sequence[VehicleTruth]],
    folder: Path,
    seed: int,
    detectors: Mapping[str, SimulatedDetector],
) -> None:
    boxes = [(frame, vehicle) for frame, now in enumerate(truths, start=1) for vehicle in now]
    judged = [pair for pair in boxes if _is_judged(pair[1])]
    ignored = (_ignored(*pair) for pair in boxes if not _is_judged(pair[1]))
    occluders = (_occluder(*pair) for pair in judged)
    _write(folder / "gt" / "gt.txt", (_truth(*pair) for pair in judged))
    _write(folder / "gt" / "occluders.csv", (OCCLUDERS_HEADER, *occluders))
    _write(folder / "ignore.txt", ignored)
    for name, detector in detectors.items():
        rows = detector.detect(truths, (scene.width, scene.height), seed)
        _write(folder / "det" / f"{name}.txt", map(_detection, rows))


def _truth(frame: int, vehicle: VehicleTruth) -> str:
    """Return the row of `gt.txt`: a vehicle of class 1, and how much of it is visible."""
    box = vehicle.box
    place = f"{box.x:.2f},{box.y:.2f},{box.width:.2f},{box.height:.2f}"
    return f"{frame},{vehicle.identity},{place},1,1,{vehicle.visible:.3f}"


def _occluder(frame: int, vehicle: VehicleTruth) -> str:
    """Return the row of `occluders.csv`."""
    hidden_by = "" if vehicle.hidden_by is None else vehicle.hidden_by
    return f"{frame},{vehicle.identity},{vehicle.depth},{hidden_by},{vehicle.hidden_share:.3f}"


def _is_judged(vehicle: VehicleTruth) -> bool:
    return min(vehicle.box.width, vehicle.box.height) >= LEAST_SIDE


def _ignored(frame: int, vehicle: VehicleTruth) -> str:
    # A margin for boxes that are not tight: a strip of 2 px is not to be hit exactly.
    box = vehicle.box
    margin = LEAST_SIDE
    sides = box.width + 2 * margin, box.height + 2 * margin
    place = f"{box.x - margin:.2f},{box.y - margin:.2f},{sides[0]:.2f},{sides[1]:.2f}"
    return f"{frame},{place},vehicle {vehicle.identity} at the border"


def _detection(row: Array) -> str:
    frame, *box, score = row.tolist()
    return f"{frame:.0f},-1,{','.join(f'{side:.2f}' for side in box)},{score:.4f},-1,-1,-1"


def _write(path: Path, rows: Iterable[str]) -> None:
    path.write_text("".join(f"{row}\n" for row in rows))
