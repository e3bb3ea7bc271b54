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

"""Run a node at a camera's rate with faults mixed in, and see whether it stays as it was.

    python test/robustness/soak.py --minutes 10

The vehicle is hidden now and then, somebody sets targets, right ones and impossible ones, and
somebody turns parameters. Prints images in and out, the time from sending a good image to its
answer, and how the resident memory went. Exit status 1 if a good image that reached the node stayed
unanswered or had no estimate, was answered twice, or a change of parameters was refused or stayed
unanswered.
"""

from __future__ import annotations

import argparse
import random
import time
from collections import Counter

import numpy as np
from faulty_messages import Drive, Faults
from node_process import NodeProcess, growth
from sensor_msgs.msg import Image

from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.trackers.registry import VARIANTS

OCCLUSION_EVERY, OCCLUSION = 20.0, 2.0
TARGET_EVERY = 13.0
CHANGE_EVERY = 5.0
"""Seconds between such events; the first of them also how long one lasts."""
CHANGES: list[tuple[str, object]] = [
    ("num_particles", 300),
    ("histogram_bits", 4),  # of the reference's effect "relearns"
    ("lost_after", 1.0),
    ("seed", 5),
    ("publish.velocity", False),
    ("num_particles", 100),
    ("window.width", 14.0),
    ("histogram_bits", 3),
    ("publish.velocity", True),
    ("evidence.clear_above", 0.85),
    ("seed", 6),
    ("window.width", 0.0),
    ("lost_after", 5.0),
    ("evidence.clear_above", 0.8),
    ("num_particles", 200),
]


class Soak:
    """Images at a rate, answers as they come.

    Parameters
    ----------
    node : NodeProcess
        The node.
    changes : list of (str, object)
        Parameters to set, one after the other and again.
    rate : float
        Good images per second.
    share : float
        Of faulty images and targets, in addition to the good ones.
    size : (int, int)
        Width and height of the good images in px.
    seed : int
        Of the faults.
    """

    def __init__(
        self,
        node: NodeProcess,
        changes: list[tuple[str, object]],
        rate: float,
        share: float,
        size: tuple[int, int],
        seed: int,
    ) -> None:
        self._node, self._changes, self._rate, self._share = node, changes, rate, share
        self._drive = Drive(*size)
        self._faults = Faults(self._drive, seed)
        self._random = random.Random(seed)
        self.sent: dict[int, tuple[Image, float]] = {}
        self.faulty: dict[int, Image] = {}
        self.latencies: list[float] = []
        self.sizes: list[tuple[float, int]] = []
        self.answers: Counter[str] = Counter()
        self.asked = self.lost = 0
        self._began = 0.0

    def run(self, seconds: float) -> None:
        """Send for this long, and wait for the last answers."""
        began = self._began = time.monotonic()
        for number in range(1, int(seconds * self._rate)):
            self._disturb(number)
            self._turn(number)
            is_hidden = self._is_due(number, OCCLUSION_EVERY, OCCLUSION)
            self.answers["hidden"] += is_hidden
            image = self._drive.image(number, is_hidden=is_hidden)
            self.sent[stamp_ns(image.header)] = image, time.monotonic()
            self._node.publish(image)
            self._faults.good()
            while (left := began + number / self._rate - time.monotonic()) > 0:
                self._node.spin(min(left, 0.002))
                self._hear()
            if number % round(self._rate) == 0:
                self.sizes.append((time.monotonic() - began, self._node.resident))
        for _ in range(50):
            self._node.spin(0.02)
            self._hear()
        self.lost = self._node.lost

    def _disturb(self, number: int) -> None:
        if self._random.random() >= self._share:
            return
        if self._random.random() < 0.2:
            self._node.publish(self._faults.target())
            self.answers["targets"] += 1
            return
        image = self._faults.image(number)
        self._node.publish(image)
        # Without its pixels, of which there would be gigabytes in an hour.
        self.faulty[stamp_ns(image.header)] = Image(
            header=image.header, height=image.height, width=image.width
        )

    def _turn(self, number: int) -> None:
        """Set the right target, or a parameter, when it is time to."""
        if self._is_due(number, TARGET_EVERY):
            self._node.publish(self._drive.target(number))
            self.answers["right targets"] += 1
        if self._changes and self._is_due(number, CHANGE_EVERY):
            self._node.set_parameter(*self._changes[self.asked % len(self._changes)])
            self.asked += 1

    def _is_due(self, number: int, every: float, lasting: float = 0.0) -> bool:
        """Test whether an event that comes `every` s happens with this image."""
        return (
            number % round(every * self._rate) <= lasting * self._rate
            and number >= every * self._rate
        )

    @property
    def changes(self) -> list[bool]:
        """Whether each change of parameters was taken, of those answered."""
        return self._node.changes

    def _hear(self) -> None:
        now = time.monotonic()
        while self._node.modes:
            answer = self._node.modes.pop(0)
            stamp = stamp_ns(answer.header)
            kind = "good" if stamp in self.sent else "faulty"
            if kind == "good":
                image, when = self.sent.pop(stamp)
                self.latencies.append(now - when)
            elif stamp in self.faulty:
                image = self.faulty[stamp]
            else:
                print(f"at {now - self._began:.1f} s a second answer to {stamp}: {answer}")
                self.answers["second answers"] += 1
                continue
            mode = self._node.check(answer, image, is_good=kind == "good")
            self.answers[f"{kind}: {mode}"] += 1


def report(soak: Soak) -> None:
    """Print what came of it."""
    print(f"images lost on the way: {soak.lost}")
    print(f"good images without an answer: {len(soak.sent)}")
    for answer, count in sorted(soak.answers.items()):
        print(f"  {answer:18} {count}")
    taken = sum(soak.changes)
    print(f"changes of parameters: {soak.asked} asked, {len(soak.changes)} answered, {taken} taken")
    middle, high, most = np.percentile(np.array(soak.latencies) * 1e3, [50, 95, 99])
    print(f"answers to good images after {middle:.1f} ms (p50), {high:.1f} (p95), {most:.1f} (p99)")
    growth(soak.sizes)


def main() -> None:
    """Run as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", default="apf")
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--rate", type=float, default=30.0, help="good images per second")
    parser.add_argument("--faults", type=float, default=0.3, help="share of faulty messages")
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240), metavar=("W", "H"))
    parser.add_argument("--best-effort", action="store_true", help="images as a camera's")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    node = NodeProcess(args.variant, "queue_depth:=10", is_reliable=not args.best_effort)
    known = Configuration.of(VARIANTS[args.variant]).specs()
    changes = [change for change in CHANGES if change[0] in known]
    soak = Soak(node, changes, args.rate, args.faults, tuple(args.size), args.seed)
    node.begin(Drive(*args.size).image(0))
    soak.run(args.minutes * 60)
    report(soak)
    node.end()
    is_bad = len(soak.sent) > soak.lost or sum(soak.changes) < soak.asked
    raise SystemExit(1 if is_bad or soak.answers["second answers"] else 0)


if __name__ == "__main__":
    main()
