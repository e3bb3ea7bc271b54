# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures of what `fusion` does on synthetic scenes, for laboratory/notes/fusion_scenes.md.

python -m laboratory.fusion.scene_pictures laboratory/notes/images
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import Normal, Stroke

from laboratory.fusion.scenes import track
from laboratory.scenes import make_scene
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.results.output_files import make_folder, replacing
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.trackers.estimate import Mode

_COLUMNS = 3
"""Frames side by side: six make two rows, and a car can still be seen."""
_VIEW = 210, 140
"""Width and height in px of what is shown of a frame."""
_GAP_PX, _ARM_PX = 2.5, 6.0
"""Distance of the corners that mark the truth from its box, and length of their arms, px."""
_DPI, _QUALITY = 130, 80
"""About 940 px wide, the width of a page, and below 150 kB."""
_RIM = (Stroke(linewidth=2.8, foreground="black"), Normal())
"""Dark edge of a line, which keeps it visible on any scenery."""
_LINES = {
    Mode.TRACKING.value: (LINE_STYLES[5].colour, "-"),
    Mode.OCCLUDED.value: (LINE_STYLES[4].colour, (0, (2, 1))),
    Mode.LOST.value: (LINE_STYLES[3].colour, (0, (1, 1))),
}
"""Colour and line of the estimated box by mode; the mode is also written above."""


@dataclass(frozen=True, slots=True)
class Picture:
    """Frames of one run, numbered from 1."""

    name: str
    scene: str
    seed: int
    frames: Sequence[int]


# Frames before, during and after what each picture is about; the same seeds as in the table.
PICTURES = (
    Picture("fusion_occlusion", "bus", 2, (36, 42, 50, 58, 62, 75)),
    Picture("fusion_neighbour", "bridge", 0, (36, 47, 58, 66, 69, 80)),
    Picture("fusion_turn", "turn", 0, (46, 53, 56, 60, 65, 80)),
    Picture("fusion_turn_hidden", "turn_occluded", 0, (36, 48, 58, 70, 79, 92)),
)


def main() -> int:
    """Draw all pictures; 1 where the folder cannot be written."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    names = [picture.name for picture in PICTURES]
    parser.add_argument("--only", nargs="+", default=names, choices=names, metavar="PICTURE")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    try:
        draw_pictures(args.folder, [one for one in PICTURES if one.name in args.only])
    except InputError as error:
        print(f"laboratory.fusion.scene_pictures: {error}", file=sys.stderr)
        return 1
    return 0


def draw_pictures(folder: Path, pictures: Sequence[Picture]) -> None:
    """Run `fusion` for every picture and write them as WebP.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    make_folder(folder)
    for picture in pictures:
        frames = list(make_scene(picture.scene, seed=picture.seed).frames())
        # Tracked from the first frame: the shown ones are late in the run.
        figure = _figure(picture, frames, track(frames, picture.seed))
        with replacing(folder / f"{picture.name}.webp") as partial:
            figure.savefig(partial, dpi=_DPI, pil_kwargs={"quality": _QUALITY})


def _figure(picture: Picture, frames: list[SceneFrame], rows: list[EstimateRow]) -> Figure:
    count = -(-len(picture.frames) // _COLUMNS)
    figure = Figure(figsize=(2.4 * _COLUMNS, 1.78 * count), layout="constrained")
    grid = list(figure.subplots(count, _COLUMNS, squeeze=False).flat)
    for axes, number in zip(grid, picture.frames, strict=False):
        _draw(axes, frames[number - 1], rows[number - 1])
    # Places of the last row that no frame is left for.
    for axes in grid[len(picture.frames) :]:
        axes.set_axis_off()
    return figure


def _box(row: EstimateRow) -> Box:
    assert row.position is not None
    assert row.width is not None
    assert row.height is not None
    return Box.around(row.position, row.width, row.height)


def _draw(axes: Axes, made: SceneFrame, row: EstimateRow) -> None:
    left, top = _corner(made, _box(row))
    right = left + _VIEW[0]
    bottom = top + _VIEW[1]
    # Cut before it is drawn: matplotlib would resample the whole frame.
    part = np.ascontiguousarray(made.frame[top:bottom, left:right])
    axes.imshow(part, extent=(left, right, bottom, top), interpolation="bicubic")
    axes.set(xlim=(left, right), ylim=(bottom, top), xticks=[], yticks=[])
    _draw_corners(axes, made.truth.box)
    colour, line = _LINES[row.mode]
    box = _box(row)
    # A dark, wider line under the coloured one keeps it visible on any ground.
    for each, width, style in (("black", 3.2, "-"), (colour, 1.8, line)):
        axes.add_patch(
            Rectangle(
                (box.x, box.y), box.width, box.height, fill=False, ec=each, lw=width, ls=style
            )
        )
    share = made.truth.visible_fraction
    assert share is not None
    axes.set_title(f"frame {row.frame}, {share:.0%} visible", fontsize=8, loc="left", pad=3)
    axes.text(
        0.03,
        0.95,
        f"{row.mode} {row.confidence:.2f}",
        transform=axes.transAxes,
        color=colour,
        fontsize=8,
        weight="bold",
        va="top",
        bbox={"color": "black", "pad": 2},
    )


def _corner(made: SceneFrame, box: Box) -> tuple[int, int]:
    """Return the top left corner of the view between the true and the estimated box."""
    # Halfway, so that both are in view where they are apart.
    middle = (np.array(made.truth.box.centre) + box.centre) / 2
    last = np.array(frame_size(made.frame)) - _VIEW
    x, y = np.clip(np.rint(middle - np.array(_VIEW) / 2), 0, last).astype(int).tolist()
    return x, y


def _draw_corners(axes: Axes, box: Box) -> None:
    """Draw the corners of a box a little outside of it, where no other box covers them."""
    left = box.x - _GAP_PX
    right = box.x + box.width + _GAP_PX
    top = box.y - _GAP_PX
    bottom = box.y + box.height + _GAP_PX
    for x, arm_x in ((left, _ARM_PX), (right, -_ARM_PX)):
        for y, arm_y in ((top, _ARM_PX), (bottom, -_ARM_PX)):
            corner = [x + arm_x, x, x], [y, y, y + arm_y]
            axes.plot(*corner, color="white", lw=1.4, path_effects=_RIM)


if __name__ == "__main__":
    sys.exit(main())
