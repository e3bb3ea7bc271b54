# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings of a red vehicle that drives over grey noise, and ways to spoil them."""

import cv2
import numpy as np
from drive import box_of, frame_of, stamp_of, truth_of
from mcap.writer import CompressionType

from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter

COUNT = 12
TARGET = "8,24,16,12"


def record(folder, *, truths=range(COUNT), count=COUNT, compression=CompressionType.LZ4):
    """Write a recording with truth for the frames `truths`."""
    with RecordingWriter(folder, compression=compression) as writer:
        for index in range(count):
            writer.write_image(stamp_of(index), frame_of(index))
            if index in truths:
                writer.write_truth(truth_of(index))
    return folder


def record_two_cameras(folder):
    with RecordingWriter(folder) as writer:
        for index in range(3):
            image = messages.image(stamp_of(index), frame_of(index))
            for topic in ("/left/image", "/right/image"):
                writer.write(topic, messages.IMAGE, stamp_of(index), image)
    return folder


def record_without_images(folder):
    with RecordingWriter(folder) as writer:
        writer.write_truth(truth_of(0))
    return folder


def frame_folder(folder, *, count=COUNT):
    """Write the vehicle as a folder of JPEG files with truth."""
    (folder / "img").mkdir(parents=True)
    lines = ["frame,x,y,w,h,visible,occ"]
    for index in range(count):
        bgr = np.ascontiguousarray(frame_of(index)[:, :, ::-1])
        cv2.imwrite(str(folder / "img" / f"{index + 1:06d}.jpg"), bgr)
        box = box_of(index)
        lines.append(f"{index + 1},{box.x},{box.y},{box.width},{box.height},1,0")
    (folder / "groundtruth.csv").write_text("\n".join(lines) + "\n")
    (folder / "sequence.json").write_text('{"fps": 25}')
    return folder


def write_video(path, frames, fps=25.0, codec="MJPG"):
    """Write RGB frames as a video."""
    frames = list(frames)
    size = frames[0].shape[1::-1]
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*codec), fps, size)
    for frame in frames:
        writer.write(np.ascontiguousarray(frame[:, :, ::-1]))
    writer.release()
    return path
