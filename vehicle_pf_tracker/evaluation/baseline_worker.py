# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trackers to compare with, behind a pipe; started by `baselines` in an environment of its own.

It imports nothing of the package: two OpenCV packages overwrite each other. Requests are lines of
JSON on standard input, and so are the answers on standard output: ``error`` for what cannot be
answered. The first answer names the versions.

``baseline_worker.py NAME [MODEL=FILE ...]`` runs one of OpenCV's trackers. A request (``height``,
``width``; ``box`` to start on this frame, as x, y, width, height) is followed by the frame's
``height * width * 3`` bytes of RGB. The answer has ``box`` (null when given up) and ``seconds`` of
this thread's CPU: the frame is turned to BGR before the clock starts, and one thread does all work.

``baseline_worker.py traffic`` scores and tracks many vehicles. Rows are (frame from 1, identity,
left, top, width, height), those of detections (frame, left, top, width, height, score):

``{"score": {"frames": F, "truth": rows, "tracks": rows}}``
    TrackEval's scores by name, of all rows.
``{"track": {"tracker": NAME, "options": {...}, "frames": F, "detections": rows}}``
    Rows of tracks by a tracker of PyPI `trackers`, and the ``seconds`` of this thread's CPU.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from importlib.metadata import version
from typing import Any, BinaryIO

import numpy as np

# By the names that users give them.
OPENCV = {
    "csrt": "TrackerCSRT",
    "kcf": "TrackerKCF",
    "mil": "TrackerMIL",
    "vit": "TrackerVit",
    "nano": "TrackerNano",
    "dasiamrpn": "TrackerDaSiamRPN",
}
TRAFFIC = {
    "sort": "SORTTracker",
    "bytetrack": "ByteTrackTracker",
    "ocsort": "OCSORTTracker",
    "cbiou": "CBIoUTracker",
}
Answers = Iterator[dict[str, Any]]


def main() -> None:
    """Answer requests until the input ends; a failure ends it only before the first answer."""
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what the libraries print must not stand between the answers
    name, *words = sys.argv[1:]
    if name == "traffic":
        replies = serve_traffic(sys.stdin.buffer)
    else:
        models = dict(word.split("=", 1) for word in words)
        replies = serve_opencv(sys.stdin.buffer, name, models)
    for reply in replies:
        answers.write(json.dumps(reply).encode() + b"\n")


def serve_opencv(requests: BinaryIO, name: str, models: dict[str, str]) -> Answers:
    """Start one of `OPENCV`'s trackers on a box, and follow it from frame to frame."""
    import cv2  # noqa: PLC0415 - the other environment need not have it

    try:
        make = tracker_maker(cv2, name, models)
    except (LookupError, cv2.error) as error:
        yield {"error": str(error.args[0])}
        return
    cv2.setNumThreads(1)
    yield {"opencv": cv2.__version__}
    tracker: Any = None
    while line := requests.readline():
        request = json.loads(line)
        # The pixels follow their request: read them even if the tracker fails, or the next line
        # would be pixels.
        shape = request["height"], request["width"], 3
        pixels = np.frombuffer(requests.read(shape[0] * shape[1] * 3), np.uint8)
        image = cv2.cvtColor(pixels.reshape(shape), cv2.COLOR_RGB2BGR)
        box = request.get("box")
        try:
            if box is not None:
                tracker = make()
            yield step(tracker, image, box)
        except cv2.error as error:
            yield {"error": str(error).strip()}


def tracker_maker(cv2: Any, name: str, models: dict[str, str]) -> Callable[[], Any]:
    """Return what makes a new tracker.

    Raises
    ------
    LookupError
        If this OpenCV does not have it.
    """
    kind = OPENCV[name]
    make: Callable[..., Any] | None = getattr(cv2, f"{kind}_create", None)
    if make is None:
        raise LookupError(
            f"OpenCV {cv2.__version__} of {sys.executable} has no {kind}; `make baselines` builds "
            "an environment that has it"
        )
    if not models:
        return make
    parameters = getattr(cv2, f"{kind}_Params")()
    for model, file in models.items():
        setattr(parameters, model, file)
    return lambda: make(parameters)


def step(tracker: Any, image: Any, box: list[int] | None) -> dict[str, Any]:
    """Start on `box`, or follow what it was started on."""
    # CPU of this thread: other cells of the grid on the machine do not count.
    before = time.thread_time()
    if box is not None:
        tracker.init(image, tuple(box))
        found = True
        new = box
    else:
        found, new = tracker.update(image)
    seconds = time.thread_time() - before
    return {"box": [float(side) for side in new] if found else None, "seconds": seconds}


def serve_traffic(requests: BinaryIO) -> Answers:
    """Score tracks, and follow vehicles through detections."""
    yield {name: version(name) for name in ("trackers", "trackeval")}
    for line in requests:
        ((task, content),) = json.loads(line).items()
        try:
            yield score(**content) if task == "score" else track(**content)
        # The libraries' own errors about odd input; the process lives on for the next request.
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            yield {"error": f"{type(error).__name__}: {error}"}


def score(frames: int, truth: list[list[float]], tracks: list[list[float]]) -> dict[str, float]:
    """Compute HOTA, CLEAR and identity scores; shares are in percent."""
    from trackeval.metrics import CLEAR, HOTA, Identity  # noqa: PLC0415 - takes two seconds

    data = sequence_data(frames, table(truth), table(tracks))
    hota = HOTA().eval_sequence(data)
    clear = CLEAR({"PRINT_CONFIG": False}).eval_sequence(data)
    identity = Identity({"PRINT_CONFIG": False}).eval_sequence(data)
    return {
        # TrackEval gives these by threshold of localisation; the score is the mean over all of
        # them.
        **{name: 100 * float(np.mean(hota[name])) for name in ("HOTA", "DetA", "AssA", "LocA")},
        "IDF1": 100 * float(identity["IDF1"]),
        "MOTA": 100 * float(clear["MOTA"]),
        "IDSW": int(clear["IDSW"]),
        "Frag": int(clear["Frag"]),
        "FP": int(clear["CLR_FP"]),
        "FN": int(clear["CLR_FN"]),
    }


def sequence_data(frames: int, truth: Any, tracks: Any) -> dict[str, Any]:
    """Arrange boxes as TrackEval's data sets do behind their preprocessing."""
    data: dict[str, Any] = {"num_timesteps": frames, "similarity_scores": []}
    for name, rows in (("gt", truth), ("tracker", tracks)):
        # TrackEval indexes by identities: numbers from 0 without a gap.
        known, numbers = np.unique(rows[:, 1], return_inverse=True)
        data[f"num_{name}_ids"] = len(known)
        data[f"num_{name}_dets"] = len(rows)
        data[f"{name}_ids"] = [numbers[rows[:, 0] == t] for t in range(1, frames + 1)]
    for t in range(1, frames + 1):
        overlap = overlaps(truth[truth[:, 0] == t, 2:], tracks[tracks[:, 0] == t, 2:])
        data["similarity_scores"].append(overlap)
    return data


def overlaps(first: Any, second: Any) -> Any:
    """Intersection over union of each pair of boxes (left, top, width, height)."""
    low = np.maximum(first[:, None, :2], second[None, :, :2])
    ends = (first[:, :2] + first[:, 2:])[:, None], (second[:, :2] + second[:, 2:])[None]
    # Boxes that lie apart have a negative extent along an axis.
    common = np.clip(np.minimum(*ends) - low, 0, None).prod(axis=2)
    union = first[:, None, 2:].prod(axis=2) + second[None, :, 2:].prod(axis=2) - common
    return common / np.maximum(union, np.finfo(float).eps)


def track(
    tracker: str, options: dict[str, float], frames: int, detections: list[list[float]]
) -> dict[str, Any]:
    """Follow all vehicles through detections with one of `TRAFFIC`."""
    import supervision  # noqa: PLC0415 - takes a second
    import trackers  # noqa: PLC0415

    # Made anew for each request: numbers of tracks must not go on from another scene.
    follower = getattr(trackers, TRAFFIC[tracker])(**options)
    rows = table(detections)
    tracks: list[list[float]] = []
    seconds = 0.0
    for frame in range(1, frames + 1):
        now = rows[rows[:, 0] == frame]
        corners = np.hstack([now[:, 1:3], now[:, 1:3] + now[:, 3:5]])
        given = supervision.Detections(xyxy=corners, confidence=now[:, 5])
        before = time.thread_time()
        followed = follower.update(given)
        seconds += time.thread_time() - before
        tracks += confirmed(frame, followed)
    return {"tracks": tracks, "seconds": seconds}


def confirmed(frame: int, found: Any) -> list[list[float]]:
    """Rows of the boxes that belong to a track; these trackers mark the others with -1."""
    if found.tracker_id is None:
        return []
    return [
        [frame, int(identity), float(x0), float(y0), float(x1 - x0), float(y1 - y0)]
        for identity, (x0, y0, x1, y1) in zip(found.tracker_id, found.xyxy, strict=True)
        if identity >= 0
    ]


def table(rows: list[list[float]]) -> Any:
    """Make an array of rows that may be empty."""
    return np.asarray(rows, dtype=np.float64).reshape(-1, 6)


if __name__ == "__main__":
    main()
