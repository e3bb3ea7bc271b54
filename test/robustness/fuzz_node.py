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

    python test/robustness/fuzz_node.py --messages 200000

Half of the messages are good images; the others are faulty ones, and targets that may be anything.
Every image has to be answered once; a good one has to have an estimate. Exit status 1 names the
first message that was not answered so.
"""

from __future__ import annotations

import argparse
import random
import time
from collections import Counter

from faulty_messages import Drive, Faults
from node_process import NodeProcess, growth


def main() -> None:
    """Fuzz as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", default="pf")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--messages", type=int, default=10_000, metavar="COUNT")
    args = parser.parse_args()
    drive, draw, answers = Drive(), random.Random(args.seed), Counter[str]()
    faults = Faults(drive, args.seed)
    node = NodeProcess(args.variant, "queue_depth:=50", "num_particles:=50")
    node.begin(drive.image(0))
    began, sizes = time.monotonic(), [(0.0, node.resident)]
    for number in range(1, args.messages + 1):
        kind = draw.choices(["good", "faulty", "target"], [5, 4, 1])[0]
        if kind == "target":
            node.publish(faults.target())
            answers["targets"] += 1
            continue
        image = drive.image(number) if kind == "good" else faults.image(number)
        mode = node.check(node.take(image), image, is_good=kind == "good")
        answers[f"{kind}: {mode}"] += 1
        if kind == "good":
            faults.good()
        if (seconds := time.monotonic() - began) >= sizes[-1][0] + 1:
            sizes.append((seconds, node.resident))
    print(f"{args.messages} messages in {time.monotonic() - began:.0f} s")
    for answer, count in sorted(answers.items()):
        print(f"  {answer:18} {count}")
    growth([*sizes, (time.monotonic() - began, node.resident)])
    node.end()


if __name__ == "__main__":
    main()
