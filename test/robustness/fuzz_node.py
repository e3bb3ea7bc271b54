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

"""Fuzz a running node through Fast DDS, in lock-step.

    python test/robustness/fuzz_node.py --images 10000 --targets 10000
    python test/robustness/fuzz_node.py --messages 200000

Every image, good or faulty, has to be answered once; a good one has to have an estimate. Exit
status 1 names the first message that was not answered so.
"""

from __future__ import annotations

import argparse
import itertools
import random
import time
from collections import Counter
from collections.abc import Iterator

from faulty_messages import Drive, Faults
from node_process import NodeProcess

MINUTE = 60.0
MB = 1e6


class Fuzzing:
    """Good and faulty messages to one node, and what came of them."""

    def __init__(self, variant: str, seed: int) -> None:
        self._drive = Drive()
        self._faults = Faults(self._drive, seed)
        self._random = random.Random(seed)
        self._numbers = itertools.count()
        self.node = NodeProcess(variant, "queue_depth:=50", "num_particles:=50")
        self.answers: Counter[str] = Counter()
        self.node.begin(self._drive.image(next(self._numbers)))

    def good(self) -> None:
        """Send a good image."""
        number = next(self._numbers)
        self._take(self._drive.image(number), number, is_good=True)
        self._faults.good()

    def faulty(self) -> None:
        """Send a faulty image."""
        number = next(self._numbers)
        self._take(self._faults.image(number), number, is_good=False)

    def target(self) -> None:
        """Send a target that may be anything."""
        self.node.publish(self._faults.target())
        self.answers["targets"] += 1

    def anything(self) -> None:
        """Send a message: a good image as often as not."""
        draw = self._random.random()
        (self.good if draw < 0.5 else self.target if draw < 0.6 else self.faulty)()

    def _take(self, image: object, number: int, *, is_good: bool) -> None:
        mode = self.node.check(self.node.take(image), image, is_good=is_good)
        self.answers[f"{'good' if is_good else 'faulty'}: {mode}"] += 1


def images(fuzzing: Fuzzing, count: int) -> Iterator[None]:
    """Send `count` faulty images, with a good one after every second."""
    for index in range(count):
        fuzzing.faulty()
        if index % 2:
            fuzzing.good()
        yield


def targets(fuzzing: Fuzzing, count: int) -> Iterator[None]:
    """Send `count` targets, with a good image after each."""
    for _ in range(count):
        fuzzing.target()
        fuzzing.good()
        yield


def messages(fuzzing: Fuzzing, count: int) -> Iterator[None]:
    """Send `count` messages of all kinds."""
    for _ in range(count):
        fuzzing.anything()
        yield


def run(fuzzing: Fuzzing, steps: Iterator[None]) -> list[tuple[float, int]]:
    """Go through the steps; return seconds and resident bytes, about once a second."""
    began = time.monotonic()
    sizes = [(0.0, fuzzing.node.resident)]
    for _ in steps:
        seconds = time.monotonic() - began
        if seconds >= sizes[-1][0] + 1:
            sizes.append((seconds, fuzzing.node.resident))
    return [*sizes, (time.monotonic() - began, fuzzing.node.resident)]


def report(name: str, fuzzing: Fuzzing, sizes: list[tuple[float, int]]) -> None:
    """Print what came of one run."""
    seconds, last = sizes[-1]
    settled = next((size for time_, size in sizes if time_ >= MINUTE), sizes[0][1])
    print(f"{name}: {sum(fuzzing.answers.values())} messages in {seconds:.0f} s")
    for answer, count in sorted(fuzzing.answers.items()):
        print(f"  {answer:18} {count}")
    print(
        f"  resident {sizes[0][1] / MB:.1f} MB at first, {settled / MB:.1f} MB "
        f"{'after a minute' if seconds >= MINUTE else 'likewise'}, {last / MB:.1f} MB at the end "
        f"({100 * (last / settled - 1):+.1f} %)"
    )


def main() -> None:
    """Fuzz as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", default="pf")
    parser.add_argument("--seed", type=int, default=0)
    kinds = {"images": images, "targets": targets, "messages": messages}
    for name in kinds:
        parser.add_argument(f"--{name}", type=int, default=0, metavar="COUNT")
    args = parser.parse_args()
    for name, kind in kinds.items():
        count = getattr(args, name)
        if count:
            fuzzing = Fuzzing(args.variant, args.seed)
            report(name, fuzzing, run(fuzzing, kind(fuzzing, count)))
            fuzzing.node.end()


if __name__ == "__main__":
    main()
