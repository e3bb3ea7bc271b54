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

"""Scenes with many vehicles as folders in MOTChallenge's layout."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.output_folder import whole_folder
from vehicle_pf_tracker.road.calibration import format_pairs
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.scenes.simulated_detectors import SIMULATED_DETECTORS, detect
from vehicle_pf_tracker.scenes.traffic_scene import TrafficScene, VehicleTruth

OCCLUDERS_HEADER = "frame,id,depth,hidden_by,share"
JPEG_QUALITY = 95
"""Quality of the images: OpenCV's default, at which edges of vehicles stay sharp."""
_ROAD_FROM = 0.5
"""Row of the farthest pairs of a road, of the image's height: clearly below its horizon."""
LEAST_SIDE = 8.0
"""Sides of a box inside the image, px, below which a vehicle has no truth but is ignored."""


def write_mot_folder(
    scene: TrafficScene,
    folder: Path,
    seed: int,
    progress: Callable[[int, int], None] = lambda number, total: None,
) -> None:
    """Render `scene` with its truth and all `SIMULATED_DETECTORS` into `folder`.

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
            for number, (frame, truth) in enumerate(scene.frames(), start=1):
                _write_image(partial / "img1" / f"{number:06d}.jpg", frame)
                truths.append(truth)
                progress(number, scene.frame_count)
            (partial / "seqinfo.ini").write_text(_information(scene, folder.resolve().name))
            _write_tables(scene, truths, partial, seed)
            if scene.road is not None:
                (partial / "road.yaml").write_text(_road(scene.road, scene.width, scene.height))
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror}") from error


def _write_image(path: Path, frame: Frame) -> None:
    bgr = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
    done, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    assert done
    path.write_bytes(data.tobytes())


def _information(scene: TrafficScene, name: str) -> str:
    return (
        f"[Sequence]\nname={name}\nimDir=img1\nframeRate={scene.frame_rate:g}\n"
        f"seqLength={scene.frame_count}\nimWidth={scene.width}\nimHeight={scene.height}\n"
        "imExt=.jpg\n"
    )


def _road(plane: RoadPlane, width: int, height: int) -> str:
    """Return a parameter file with pairs of the road: a grid below the horizon."""
    columns, rows = np.meshgrid(np.linspace(0, width, 3), np.linspace(_ROAD_FROM, 1, 3) * height)
    pixels = np.stack([columns, rows], axis=-1).reshape(-1, 2)
    pairs = tuple(
        Pair((u, v), (x, y))
        for (u, v), (x, y) in zip(pixels.tolist(), plane.to_road(pixels).tolist(), strict=True)
    )
    return f'/**:\n  ros__parameters:\n    road.pairs: "{format_pairs(pairs)}"\n'


def _write_tables(
    scene: TrafficScene, truths: Sequence[Sequence[VehicleTruth]], folder: Path, seed: int
) -> None:
    boxes = [(frame, one) for frame, now in enumerate(truths, start=1) for one in now]
    _write(folder / "gt" / "gt.txt", (truth_row(*one) for one in boxes if _is_judged(one[1])))
    judged = [pair for pair in boxes if _is_judged(pair[1])]
    _write(
        folder / "gt" / "occluders.csv",
        (OCCLUDERS_HEADER, *(_occluder(*pair) for pair in judged)),
    )
    _write(folder / "ignore.txt", (_ignored(*one) for one in boxes if not _is_judged(one[1])))
    for name, detector in SIMULATED_DETECTORS.items():
        found = detect(detector, truths, (scene.width, scene.height), seed)
        _write(folder / "det" / f"{name}.txt", map(_detection, found))


def truth_row(frame: int, one: VehicleTruth) -> str:
    """Return the row of `gt.txt`: a vehicle of class 1, and how much of it is visible."""
    box = one.box
    place = f"{box.x:.2f},{box.y:.2f},{box.width:.2f},{box.height:.2f}"
    return f"{frame},{one.identity},{place},1,1,{one.visible:.3f}"


def _occluder(frame: int, one: VehicleTruth) -> str:
    """Return the row of `occluders.csv`."""
    hidden_by = "" if one.hidden_by is None else one.hidden_by
    return f"{frame},{one.identity},{one.depth},{hidden_by},{one.hidden_share:.3f}"


def _is_judged(one: VehicleTruth) -> bool:
    return min(one.box.width, one.box.height) >= LEAST_SIDE


def _ignored(frame: int, one: VehicleTruth) -> str:
    # A margin for boxes that are not tight: a strip of 2 px is not to be hit exactly.
    box, margin = one.box, LEAST_SIDE
    sides = box.width + 2 * margin, box.height + 2 * margin
    place = f"{box.x - margin:.2f},{box.y - margin:.2f},{sides[0]:.2f},{sides[1]:.2f}"
    return f"{frame},{place},vehicle {one.identity} at the border"


def _detection(row: Array) -> str:
    frame, *box, score = row.tolist()
    return f"{frame:.0f},-1,{','.join(f'{side:.2f}' for side in box)},{score:.4f},-1,-1,-1"


def _write(path: Path, rows: Iterable[str]) -> None:
    path.write_text("".join(f"{row}\n" for row in rows))
