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

"""Measure how long a node takes from its start to its first answered service.

    python -m benchmarks.cold_start

With an empty cache of compiled kernels, with a filled one, without numba's kernels, and, for what
ROS itself takes, an rclpy node that does nothing. Wall-clock time; discovery is part of it. The
kinds take turns. A node is asked for its state, the empty one for its parameters.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import rclpy
from lifecycle_msgs.srv import GetState
from rcl_interfaces.srv import ListParameters
from rclpy.executors import SingleThreadedExecutor

_PATIENCE = 120.0
"""Seconds until a node that does not answer has failed."""
_AGAIN = 0.5
"""Seconds until a request is repeated: a node that has not yet found the asker answers in vain."""
_NODE = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main({variant!r}))"
_EMPTY = "import rclpy; rclpy.init(); rclpy.spin(rclpy.create_node('empty'))"
_KINDS = ("cold", "warm", "opencv", "empty")


class Asker:
    """Starts nodes and asks each until it answers."""

    def __init__(self) -> None:
        rclpy.init()
        self._node = rclpy.create_node("asker")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)

    def first_answer(self, kind: str, variant: str) -> float:
        """Seconds from the start of a node to its first answer."""
        with tempfile.TemporaryDirectory() as empty:
            environment = {**os.environ, **({"NUMBA_CACHE_DIR": empty} if kind == "cold" else {})}
            began = time.monotonic()
            process = subprocess.Popen(
                _command(kind, variant),
                env=environment,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            try:
                self._ask(kind, variant, began + _PATIENCE)
                return time.monotonic() - began
            finally:
                process.send_signal(signal.SIGINT)
                process.wait(_PATIENCE)

    def _ask(self, kind: str, variant: str, deadline: float) -> None:
        service: tuple[Any, str] = (GetState, f"/{variant}_tracker/get_state")
        if kind == "empty":
            service = (ListParameters, "/empty/list_parameters")
        client = self._node.create_client(*service)
        try:
            while time.monotonic() < deadline:
                if not client.service_is_ready():
                    self._executor.spin_once(timeout_sec=0.005)
                    continue
                future = client.call_async(service[0].Request())
                self._executor.spin_until_future_complete(future, timeout_sec=_AGAIN)
                if future.done():
                    return
            raise SystemExit(f"the node {kind} did not answer within {_PATIENCE:.0f} s")
        finally:
            self._node.destroy_client(client)

    def forget(self, seconds: float = 1.0) -> None:
        """Listen until the ended node is gone from the graph."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)


def _command(kind: str, variant: str) -> list[str]:
    if kind == "empty":
        return [sys.executable, "-c", _EMPTY]
    words = [sys.executable, "-c", _NODE.format(variant=variant), "--ros-args"]
    return [*words, "-p", f"kernels:={'opencv' if kind == 'opencv' else 'auto'}"]


def measure(
    asker: Asker, variant: str, kinds: Sequence[str], repeats: int
) -> Mapping[str, list[float]]:
    """Return the times of each kind in s."""
    asker.first_answer("warm", variant)  # leaves what it read in the system's cache
    times: dict[str, list[float]] = {kind: [] for kind in kinds}
    for _ in range(repeats):
        for kind in kinds:
            asker.forget()
            times[kind].append(asker.first_answer(kind, variant))
    return times


def main() -> None:
    """Measure as asked and print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("variants", nargs="*", default=["apf", "fusion"])
    parser.add_argument("--kinds", nargs="+", default=_KINDS, choices=_KINDS)
    parser.add_argument("--repeats", type=int, default=10)
    args = parser.parse_args()
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    asker = Asker()
    print("| variant | kind | starts | shortest, s | median, s | longest, s |")
    print("| --- | --- | ---: | ---: | ---: | ---: |")
    for variant in args.variants:
        load = os.getloadavg()[0]
        for kind, times in measure(asker, variant, args.kinds, args.repeats).items():
            numbers = " | ".join(f"{f(times):.2f}" for f in (np.min, np.median, np.max))
            print(f"| `{variant}` | {kind} | {len(times)} | {numbers} |", flush=True)
        print(f"load {load:.1f} to {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
