# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The README's animation: `fusion` and `pf` through both occlusions of the scene `highway`.

    python -m tools.animation docs/images/occlusions.webp

Both run on the whole frames; the far carriageway is shown.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.parameters.table import Value, from_mapping
from vehicle_pf_tracker.results.output_files import replacing
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.showing.drawing import write_words
from vehicle_pf_tracker.showing.target_drawing import MODE_COLOURS, Annotator
from vehicle_pf_tracker.trackers.registry import find_variant

SCENE = "highway"
"""Scene in which a bridge, and then a lorry, hide the vehicle."""
SEED = 0
"""Seed of the scene and of both trackers, the first: it was not chosen among others."""
# `pf` has its best sigma, found on other scenes and seeds: `python -m reproduction.demo_sigma`.
CONTESTANTS: Mapping[str, Mapping[str, Value]] = {
    "fusion": {},
    "pf": {"num_particles": 200, "histogram_bits": 3, "sigma": 2.0},
}
"""Parameters over the defaults, by variant."""
ROWS = slice(50, 200)
"""Rows of the scene that are shown: the far carriageway, and grass above it for the words."""
EVERY = 2
"""Every second frame is shown: 15 a second look smooth and halve the file."""
QUALITY = 40
"""WebP's quality, at which the boxes' edges are still clean."""
EFFORT = 6
"""WebP's greatest effort, which takes a minute: 0.92 MB, where the default leaves 1.34 MB."""
HOLD_MS = 1500
"""Time that the last picture stays, ms."""
GAP_PX = 4
"""Height of the line between the two, px."""


def pictures(frames: Sequence[SceneFrame]) -> Iterator[Frame]:
    """Track through `frames` with both variants; give every picture, one above the other."""
    shown = [_annotated(name, frames) for name in CONTESTANTS]
    for above, below in zip(*shown, strict=True):
        line = np.full((GAP_PX, above.shape[1], 3), 255, np.uint8)
        yield np.vstack([above, line, below])


def write_animation(path: Path, shown: Iterable[Frame], frame_ms: float) -> None:
    """Write pictures as an animated WebP that repeats for ever."""
    images = [Image.fromarray(picture) for picture in shown]
    times = [round(frame_ms)] * (len(images) - 1) + [HOLD_MS]
    with replacing(path) as partial:
        images[0].save(
            partial,
            save_all=True,
            append_images=images[1:],
            duration=times,
            loop=0,
            quality=QUALITY,
            method=EFFORT,
        )


def _annotated(name: str, frames: Sequence[SceneFrame]) -> Iterator[Frame]:
    variant = find_variant(name)
    parameters = from_mapping(variant.parameters, {**CONTESTANTS[name], "seed": SEED})
    tracker = OfflineTracker(variant, parameters, first_truth=frames[0].truth)
    annotator = Annotator()
    rows = tracker.rows((frame.truth.stamp_ns, frame.frame) for frame in frames)
    for scene_frame, row in zip(frames, rows, strict=True):
        picture = scene_frame.frame.copy()
        annotator.follow(tracker.estimate)
        annotator.draw(picture, tracker.estimate)
        strip = picture[ROWS].copy()
        write_words(strip, f"{name}: {row.mode}", (8, 24), MODE_COLOURS[row.mode], 2)
        yield strip


def main(path: Path) -> None:
    """Make the animation."""
    scene = make_scene(SCENE, seed=SEED)
    shown = itertools.islice(pictures(list(scene.frames())), 0, None, EVERY)
    write_animation(path, shown, EVERY * 1e3 / scene.frame_rate)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
