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

"""Ask a node for changes of a parameter while VGA images keep it busy, and count the answers.

    python test/robustness/service_requests.py

Bursts of requests from one client, four clients at 200 Hz each, with the replies' queue that ROS
gives them and with a long one, and one call after the other. Clients are processes of their own.
`--empty` asks an rclpy node that does nothing else. Prints a table; exit status 1 if a request of a
burst or one of the calls stayed unanswered.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
import rclpy
from faulty_messages import Drive
from node_process import NodeProcess
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile

from vehicle_pf_tracker.ros.transport import image_transport

RATE = 30.0
SIZE = (640, 480)
BURSTS = (30, 50, 200)
CLIENTS, CLIENT_RATE, CLIENT_REQUESTS = 4, 200.0, 1000
QUEUES = (10, 1000)
"""Replies that a client keeps: ROS's default, and room for all."""
CALLS = 500
PATIENCE = 20.0
"""Seconds to wait for the last answers; those that were lost never come."""
EMPTY = """
import rclpy
rclpy.init()
node = rclpy.create_node("pf_tracker")
node.declare_parameter("sigma", 3.0)
try:
    rclpy.spin(node)
except BaseException:
    pass
"""


@dataclass(frozen=True, slots=True)
class Answers:
    """Outcome of some requests.

    Attributes
    ----------
    asked : int
        Number of requests.
    waits : list of float
        Time from each answered request to its answer, s.
    seconds : float
        From the first request to the last answer.
    """

    asked: int
    waits: list[float]
    seconds: float


class Asker:
    """A client of the node's parameters.

    Parameters
    ----------
    queue : int
        Replies that it keeps, those to other clients of the service among them.
    """

    def __init__(self, queue: int) -> None:
        rclpy.init()
        self._node: Node = rclpy.create_node(f"asker_{os.getpid()}")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._client: Client = self._node.create_client(
            SetParameters, "/pf_tracker/set_parameters", qos_profile=QoSProfile(depth=queue)
        )
        self._waits: list[float] = []
        self._last = 0.0
        if not self._client.wait_for_service(PATIENCE):
            raise SystemExit("there is no node to ask")

    def burst(self, count: int) -> Answers:
        """Ask `count` times without a pause."""
        return self._asked(count, 0.0)

    def steadily(self, count: int) -> Answers:
        """Ask `count` times at `CLIENT_RATE`."""
        return self._asked(count, 1 / CLIENT_RATE)

    def in_turn(self, count: int) -> Answers:
        """Ask `count` times, each after the answer to the last."""
        began = time.monotonic()
        for number in range(count):
            self._ask(number)
            self._listen(number + 1)
        return self._answers(count, began)

    def _asked(self, count: int, period: float) -> Answers:
        began = time.monotonic()
        for number in range(count):
            while (left := began + number * period - time.monotonic()) > 0:
                self._executor.spin_once(timeout_sec=left)
            self._ask(number)
        self._listen(count)
        return self._answers(count, began)

    def _ask(self, number: int) -> None:
        value = ParameterValue(
            type=ParameterType.PARAMETER_DOUBLE, double_value=3.0 + number * 1e-3
        )
        request = SetParameters.Request(parameters=[Parameter(name="sigma", value=value)])
        sent = time.monotonic()
        self._client.call_async(request).add_done_callback(lambda _: self._hear(sent))

    def _hear(self, sent: float) -> None:
        self._last = time.monotonic()
        self._waits.append(self._last - sent)

    def _listen(self, count: int) -> None:
        deadline = time.monotonic() + PATIENCE
        while len(self._waits) < count and (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def _answers(self, count: int, began: float) -> Answers:
        return Answers(count, self._waits, self._last - began)


def ask(manner: str, count: str, queue: str) -> None:
    """Print what came of asking, as JSON: the work of a client's process."""
    answers: Answers = getattr(Asker(int(queue)), manner)(int(count))
    print(json.dumps(asdict(answers)))
    rclpy.try_shutdown()


def start_asker(manner: str, count: int, queue: int) -> subprocess.Popen[str]:
    """Start a client in a process of its own."""
    words = [sys.executable, __file__, "--ask", manner, str(count), str(queue)]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def heard_by(asker: subprocess.Popen[str]) -> Answers:
    """Return what a client's process printed."""
    printed, _ = asker.communicate(timeout=PATIENCE)
    if asker.returncode:
        raise SystemExit("a client has failed")
    return Answers(**json.loads(printed))


class Camera:
    """Shows images to the node while others ask it.

    Parameters
    ----------
    node : NodeProcess or None
        The node; None where nobody looks.
    """

    def __init__(self, node: NodeProcess | None) -> None:
        self._node = node
        self._drive = Drive(*SIZE)
        self._number = 0
        self.shown = self.answered = 0
        if node is not None:
            node.begin(self._drive.image(0))

    def show_until(self, is_done: Callable[[], bool]) -> None:
        """Show images at `RATE` until the askers are done."""
        due = time.monotonic()
        while not is_done():
            due += 1 / RATE
            if self._node is None:
                time.sleep(1 / RATE)
                continue
            self._number += 1
            self.shown += 1
            self._node.publish(self._drive.image(self._number))
            self._node.spin(max(due - time.monotonic(), 0.001))
            self.answered += len(self._node.modes)
            self._node.modes.clear()


def measure(camera: Camera, manner: str, count: int, *, clients: int = 1, queue: int) -> bool:
    """Print a row of the table; return whether everything was answered."""
    askers = [start_asker(manner, count, queue) for _ in range(clients)]
    camera.show_until(lambda: all(asker.poll() is not None for asker in askers))
    answers = [heard_by(asker) for asker in askers]
    asked = sum(one.asked for one in answers)
    waits = np.concatenate([one.waits for one in answers]) * 1e3
    rate = len(waits) / max(one.seconds for one in answers)
    words = {"burst": "burst", "steadily": f"{CLIENT_RATE:.0f} Hz", "in_turn": "one by one"}
    print(
        f"| {words[manner]} | {clients} | {queue} | {asked} | {len(waits)} | {rate:.0f} | "
        f"{np.median(waits):.0f} | {waits.max():.0f} |",
        flush=True,
    )
    return bool(len(waits) == asked)


def measure_all(camera: Camera, *, is_quick: bool) -> bool:
    """Print the table; return whether every burst and call was answered."""
    print("| requests | clients | queue | asked | answered | a second | median, ms | longest, ms |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    bursts = BURSTS[:1] if is_quick else BURSTS
    is_whole = [measure(camera, "burst", count, queue=QUEUES[1]) for count in bursts]
    for queue in () if is_quick else QUEUES:
        measure(camera, "steadily", CLIENT_REQUESTS, clients=CLIENTS, queue=queue)
    is_whole.append(measure(camera, "in_turn", CALLS // 10 if is_quick else CALLS, queue=QUEUES[0]))
    print(f"images shown {camera.shown}, answered {camera.answered}")
    return all(is_whole)


def main() -> None:
    """Run as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--empty", action="store_true", help="ask a node that does nothing else")
    parser.add_argument("--quick", action="store_true", help="a burst of 30 and 50 calls alone")
    parser.add_argument("--ask", nargs=3, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.ask:
        ask(*args.ask)
        return
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    if args.empty:
        with subprocess.Popen([sys.executable, "-c", EMPTY]) as process:
            is_whole = measure_all(Camera(None), is_quick=args.quick)
            process.terminate()
    else:
        with image_transport(SIZE[0] * SIZE[1] * 3, rclpy.get_rmw_implementation_identifier()):
            node = NodeProcess("pf", "queue_depth:=10")
            is_whole = measure_all(Camera(node), is_quick=args.quick)
            node.end()
    raise SystemExit(0 if is_whole else 1)


if __name__ == "__main__":
    main()
