# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A red vehicle that drives through a textured picture, as a frame folder."""

import json

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.grounds import value_noise

WIDTH, HEIGHT, COUNT, FPS = 256, 96, 130, 25
RED = (230, 20, 20)
"""Nothing else in the pictures is as red as this."""
VEHICLE = (20, 14)


def course(index):
    return 8 + 1.5 * index, 40.0


def turning_course(index):
    return (8 + 1.5 * index, 30.0) if index < 60 else (98.0, 30.0 + 0.9 * (index - 60))


def background(width=WIDTH, height=HEIGHT):
    rng = np.random.default_rng(5)
    shades = [value_noise((height, width), (cell, cell), rng) for cell in (3, 11)]
    grey = 110 + 40 * shades[0] + 40 * shades[1]
    return np.repeat(np.clip(grey, 0, 255)[..., np.newaxis], 3, axis=2).astype(np.uint8)


def box_of(index, way=course):
    x, y = way(index)
    return Box(round(x), round(y), *VEHICLE)


def write_sequence(folder, *, count=COUNT, way=course, pan=0, occlusion=None):
    """Write the sequence; the camera pans by `pan` px in each frame."""
    (folder / "img").mkdir(parents=True)
    wide = background(WIDTH + pan * count)
    lines = ["frame,x,y,w,h,visible,occ"]
    for index in range(count):
        frame = wide[:, pan * index : pan * index + WIDTH].copy()
        box = box_of(index, way)
        x, y = int(box.x), int(box.y)
        frame[y : y + VEHICLE[1], x : x + VEHICLE[0]] = RED
        cv2.imwrite(str(folder / "img" / f"{index + 1:06d}.png"), frame[..., ::-1])
        occ = occlusion(index) if occlusion else 0
        lines.append(f"{index + 1},{box.x},{box.y},{box.width},{box.height},{int(occ < 2)},{occ}")
    (folder / "groundtruth.csv").write_text("\n".join(lines) + "\n")
    (folder / "sequence.json").write_text(json.dumps({"fps": FPS}))
    return folder


def red_share(frame, box):
    """Share of a box's pixels that show the vehicle."""
    x, y = round(box.x), round(box.y)
    part = frame[y : y + round(box.height), x : x + round(box.width)].astype(int)
    return float(np.mean(part[..., 0] - part[..., 1] > 100))
