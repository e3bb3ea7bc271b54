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

"""One of OpenCV's trackers behind a pipe: `python worker.py NAME`, started by `client`.

It runs in an environment of its own, since two OpenCV packages overwrite each other, so that it
imports nothing but cv2, numpy and the standard library. On standard input come requests, each a
line of JSON (``height``, ``width``; ``box`` to start on this frame, as x, y, width, height) and
then the frame's ``height * width * 3`` bytes of RGB. On standard output goes a line of JSON for
each: ``box`` (null when given up) and ``seconds`` of this thread's CPU, or ``error``. The first
line of all names OpenCV's version.

The frame is turned to OpenCV's BGR before the clock starts, and one thread does all the work, so
that the seconds are the tracker's own.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any, BinaryIO

import cv2
import numpy as np

CLASSES = {
    "csrt": "TrackerCSRT",
    "kcf": "TrackerKCF",
    "mil": "TrackerMIL",
    "vit": "TrackerVit",
    "nano": "TrackerNano",
    "dasiamrpn": "TrackerDaSiamRPN",
}


def main() -> None:
    """Answer requests until the input ends; models come as ``name=file`` behind the name."""
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what OpenCV prints must not stand between the answers
    try:
        make = tracker_maker(sys.argv[1], dict(word.split("=", 1) for word in sys.argv[2:]))
    except (LookupError, cv2.error) as error:
        send(answers, {"error": str(error.args[0])})
        return
    cv2.setNumThreads(1)
    send(answers, {"opencv": cv2.__version__})
    serve(sys.stdin.buffer, answers, make)


def tracker_maker(name: str, models: dict[str, str]) -> Callable[[], Any]:
    """Return what makes a new tracker.

    Raises
    ------
    LookupError
        If this OpenCV does not have it.
    """
    kind = CLASSES[name]
    homes = [cv2, getattr(cv2, "legacy", None)]
    create = next(
        (found for home in homes if (found := getattr(home, f"{kind}_create", None))), None
    )
    if create is None:
        raise LookupError(
            f"OpenCV {cv2.__version__} of {sys.executable} has no {kind}, neither in cv2 nor in "
            "cv2.legacy; `make baselines` builds an environment that has it"
        )
    make: Callable[..., Any] = create
    if not models:
        return make
    parameters = getattr(cv2, f"{kind}_Params")()
    for model, file in models.items():
        setattr(parameters, model, file)
    return lambda: make(parameters)


def serve(requests: BinaryIO, answers: BinaryIO, make: Callable[[], Any]) -> None:
    """Answer one request after the other."""
    tracker: Any = None
    while line := requests.readline():
        request = json.loads(line)
        shape = request["height"], request["width"], 3
        pixels = np.frombuffer(requests.read(shape[0] * shape[1] * 3), np.uint8)
        image = cv2.cvtColor(pixels.reshape(shape), cv2.COLOR_RGB2BGR)
        box = request.get("box")
        try:
            if box is not None:
                tracker = make()
            send(answers, track(tracker, image, box))
        except cv2.error as error:
            send(answers, {"error": str(error).strip()})


def track(tracker: Any, image: Any, box: list[int] | None) -> dict[str, object]:
    """Start on `box`, or follow what it was started on."""
    before = time.thread_time()
    if box is not None:
        tracker.init(image, tuple(box))
        found, new = True, box
    else:
        found, new = tracker.update(image)
    seconds = time.thread_time() - before
    return {"box": [float(side) for side in new] if found else None, "seconds": seconds}


def send(answers: BinaryIO, message: dict[str, object]) -> None:
    """Write one line."""
    answers.write(json.dumps(message).encode() + b"\n")


if __name__ == "__main__":
    main()
