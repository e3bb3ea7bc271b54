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

"""TrackEval's metrics and the trackers of PyPI `trackers`, behind a pipe: started by `client`.

It runs in an environment of its own and imports nothing else but NumPy and the standard library. On
standard input come requests, one line of JSON each:

``{"score": {"frames": F, "truth": rows, "tracks": rows}}``
    Scores by name. Rows are (frame from 1, identity, left, top, width, height); whatever is not to
    be scored has been left out before.
``{"track": {"tracker": NAME, "options": {...}, "frames": F, "detections": rows}}``
    Rows of tracks, and the ``seconds`` of this thread's CPU. Rows of detections are (frame, left,
    top, width, height, score).

On standard output goes one line of JSON for each; ``error`` where it cannot be answered. The first
line of all names the versions.
"""

from __future__ import annotations

import json
import os
import sys
import time
from importlib.metadata import version
from typing import Any

import numpy as np

CLASSES = {
    "sort": "SORTTracker",
    "bytetrack": "ByteTrackTracker",
    "ocsort": "OCSORTTracker",
    "cbiou": "CBIoUTracker",
}


def main() -> None:
    """Answer requests until the input ends."""
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what the libraries print must not stand between the answers
    send(answers, {name: version(name) for name in ("trackers", "trackeval")})
    for line in sys.stdin.buffer:
        ((task, content),) = json.loads(line).items()
        try:
            send(answers, score(**content) if task == "score" else track(**content))
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            send(answers, {"error": f"{type(error).__name__}: {error}"})


def score(frames: int, truth: list[list[float]], tracks: list[list[float]]) -> dict[str, float]:
    """Compute HOTA, CLEAR and identity scores; shares are in percent."""
    from trackeval.metrics import CLEAR, HOTA, Identity  # noqa: PLC0415 - takes two seconds

    data = sequence_data(frames, table(truth, 6), table(tracks, 6))
    hota = HOTA().eval_sequence(data)
    clear = CLEAR({"PRINT_CONFIG": False}).eval_sequence(data)
    identity = Identity({"PRINT_CONFIG": False}).eval_sequence(data)
    return {
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
        known, numbers = np.unique(rows[:, 1], return_inverse=True)
        data[f"num_{name}_ids"], data[f"num_{name}_dets"] = len(known), len(rows)
        data[f"{name}_ids"] = [numbers[rows[:, 0] == t] for t in range(1, frames + 1)]
    for t in range(1, frames + 1):
        overlap = overlaps(truth[truth[:, 0] == t, 2:], tracks[tracks[:, 0] == t, 2:])
        data["similarity_scores"].append(overlap)
    return data


def overlaps(first: Any, second: Any) -> Any:
    """Intersection over union of each pair of boxes (left, top, width, height)."""
    low = np.maximum(first[:, None, :2], second[None, :, :2])
    high = np.minimum(
        first[:, None, :2] + first[:, None, 2:], second[None, :, :2] + second[None, :, 2:]
    )
    common = np.clip(high - low, 0, None).prod(axis=2)
    union = first[:, None, 2:].prod(axis=2) + second[None, :, 2:].prod(axis=2) - common
    return common / np.maximum(union, np.finfo(float).eps)


def track(
    tracker: str, options: dict[str, float], frames: int, detections: list[list[float]]
) -> dict[str, Any]:
    """Follow all vehicles through detections with one of `CLASSES`."""
    import supervision  # noqa: PLC0415 - takes a second
    import trackers  # noqa: PLC0415

    one = getattr(trackers, CLASSES[tracker])(**options)
    rows = table(detections, 6)
    tracks: list[list[float]] = []
    seconds = 0.0
    for frame in range(1, frames + 1):
        now = rows[rows[:, 0] == frame]
        corners = np.hstack([now[:, 1:3], now[:, 1:3] + now[:, 3:5]])
        given = supervision.Detections(xyxy=corners, confidence=now[:, 5])
        before = time.thread_time()
        found = one.update(given)
        seconds += time.thread_time() - before
        tracks += confirmed(frame, found)
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


def table(rows: list[list[float]], columns: int) -> Any:
    """Make an array of rows that may be empty."""
    return np.asarray(rows, dtype=np.float64).reshape(-1, columns)


def send(answers: Any, message: dict[str, Any]) -> None:
    """Write one line."""
    answers.write(json.dumps(message).encode() + b"\n")


if __name__ == "__main__":
    main()
