# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Real nodes over Fast DDS, each test run in a ROS domain of its own.

Nothing here sleeps for a guessed time: `RosBench.wait_for` spins until a condition holds.
"""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
import tempfile
import time
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest
from built_messages import TF2, VISION, build, missing
from loaded_python import Forked, LoadedPython

try:
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
except ImportError:
    rclpy = None

ROOT = Path(__file__).resolve().parents[2]
DOMAINS = range(1, 102)
TIMEOUT = 120.0
"""Bound of every wait for a state, s: generous, since only a failure waits so long."""
PATIENCE = 20.0
"""Time after which a process that does not end is killed, s."""
LOADED = (
    "vehicle_pf_tracker.cli.main",
    "vehicle_pf_tracker.ros.executables",
    "vehicle_pf_tracker.ros.node.tracker_node",
    "vehicle_pf_tracker.ros.process",
    "vehicle_pf_tracker.ros.traffic.traffic_node",
    "vehicle_pf_tracker.trackers.papers.apf",
)
"""Modules that processes are forked with."""
NO_ROS = "rclpy is not installed (pip install '.[ros]')"


@pytest.fixture(scope="session", autouse=True)
def ros_domain():
    """Keep a domain id that no other test run on this machine has, on the local host only."""
    folder = Path(tempfile.gettempdir(), "vehicle_pf_tracker_domains")
    folder.mkdir(mode=0o777, exist_ok=True)
    first = os.getpid() % len(DOMAINS)
    for domain in [*DOMAINS[first:], *DOMAINS[:first]]:
        lock = (folder / str(domain)).open("w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        with pytest.MonkeyPatch.context() as patch, lock:
            patch.setenv("ROS_DOMAIN_ID", str(domain))
            patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
            yield domain
        return
    pytest.fail("all ROS domain ids are taken by other test runs")


@pytest.fixture(scope="session", autouse=True)
def compiled_kernels():
    """Compile the kernels once: a node with a cold cache answers WAITING for a minute."""
    code = "from vehicle_pf_tracker.image.kernels.interface import compile_all; compile_all('auto')"
    subprocess.run([sys.executable, "-c", code], check=False, timeout=600)


@pytest.fixture(scope="session", autouse=True)
def hangups():
    """Let child processes take SIGHUP as ever, also where nohup started the tests."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


class RosBench:
    """One rclpy context and executor, and a node named `tester` to talk to others from."""

    def __init__(self, domain: int) -> None:
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.nodes = []
        self.node = self.add(rclpy.create_node("tester", context=self.context))

    def add(self, node):
        """Spin `node` too, and destroy it in the end."""
        self.nodes.append(node)
        self.executor.add_node(node)
        return node

    def remove(self, node):
        self.nodes.remove(node)
        self.executor.remove_node(node)
        node.destroy_node()

    def wait_for(self, condition, timeout: float = TIMEOUT):
        """Spin until `condition()` is true, and return what it returned; fail after `timeout` s."""
        deadline = time.monotonic() + timeout
        while not (result := condition()):
            assert time.monotonic() < deadline, f"not within {timeout:g} s"
            self.executor.spin_once(timeout_sec=0.02)
        return result

    def publish_until(self, condition, publisher, message, timeout: float = TIMEOUT):
        """Publish again and again until `condition()` is true, and return what it returned.

        For subscribers in other processes: they may match later than the publisher sees them.
        """
        deadline = time.monotonic() + timeout
        while not (result := condition()):
            assert time.monotonic() < deadline, f"not within {timeout:g} s"
            publisher.publish(message)
            self.executor.spin_once(timeout_sec=0.2)
        return result

    def wait_until_matched(self, *endpoints, count: int = 1, timeout: float = TIMEOUT):
        """Spin until each publisher or subscription has at least `count` counterparts."""
        self.wait_for(lambda: all(_matches(one) >= count for one in endpoints), timeout)

    def publisher(self, kind, topic, qos=10, count: int = 1):
        """Make a publisher and wait until it is matched."""
        made = self.node.create_publisher(kind, topic, qos)
        self.wait_until_matched(made, count=count)
        return made

    def collect(self, kind, topic, qos=10, count: int = 1):
        """Subscribe, wait until matched, and return the list that messages are appended to."""
        received = []
        made = self.node.create_subscription(kind, topic, received.append, qos)
        self.wait_until_matched(made, count=count)
        return received

    def call(self, kind, name, request, timeout: float = TIMEOUT):
        """Call a service and return its response."""
        client = self.node.create_client(kind, name)
        self.wait_for(client.service_is_ready, timeout)
        future = client.call_async(request)
        self.wait_for(future.done, timeout)
        self.node.destroy_client(client)
        return future.result()

    def close(self):
        for node in self.nodes:
            self.executor.remove_node(node)
            node.destroy_node()
        self.executor.shutdown()
        rclpy.shutdown(context=self.context)


def _matches(endpoint) -> int:
    count = getattr(endpoint, "get_subscription_count", None)
    return count() if count is not None else endpoint.get_publisher_count()


def _bench(domain):
    if rclpy is None:
        pytest.skip(NO_ROS)
    made = RosBench(domain)
    yield made
    made.close()


@pytest.fixture
def bench(ros_domain):
    """One participant of the domain."""
    yield from _bench(ros_domain)


@pytest.fixture
def other_bench(ros_domain):
    """A second participant, as another process would be."""
    yield from _bench(ros_domain)


def settings(**environment: str) -> dict[str, str]:
    """Return the environment of a child process, which imports the package from here."""
    paths = filter(None, [str(ROOT), os.environ.get("PYTHONPATH")])
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **environment}


class Process:
    """A child process whose output is kept in a file."""

    def __init__(self, command: list[str], log: Path, **environment: str) -> None:
        self.log = log
        self.popen: subprocess.Popen | Forked
        with log.open("w") as output:
            self.popen = subprocess.Popen(
                command, stdout=output, stderr=subprocess.STDOUT, env=settings(**environment)
            )

    @classmethod
    def forked(cls, python: LoadedPython, code: str, arguments: list[str], log: Path) -> Process:
        """Run `python -c CODE ARGUMENTS` where ROS and the package are loaded."""
        process = cls.__new__(cls)
        process.log = log
        with log.open("w") as output:
            process.popen = python.run(code, arguments, settings(), output, output)
        return process

    @property
    def output(self) -> str:
        return self.log.read_text()

    def send(self, number: int) -> None:
        os.kill(self.popen.pid, number)

    def wait(self, timeout: float = TIMEOUT) -> int:
        return self.popen.wait(timeout)

    def wait_for_output(self, words: str, timeout: float = TIMEOUT) -> str:
        deadline = time.monotonic() + timeout
        while words not in (output := self.output):
            assert self.popen.poll() is None, f"ended with {self.popen.returncode}:\n{output}"
            assert time.monotonic() < deadline, f"{words!r} not within {timeout:g} s:\n{output}"
            time.sleep(0.02)
        return output

    def end(self) -> None:
        """End it in order: a participant that is killed is missed in the domain's shared memory.

        Fast DDS 2.14 then makes a port anew in all others, and crashes in one that ends meanwhile.
        """
        self.popen.terminate()
        try:
            self.popen.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()


@pytest.fixture(scope="session")
def loaded_python(ros_domain, hangups):
    """The process that the others are forked from."""
    if rclpy is None:
        pytest.skip(NO_ROS)
    python = LoadedPython(LOADED, settings())
    yield python
    python.close()


@pytest.fixture
def start_process(loaded_python, tmp_path):
    """Return a function that runs a command (after this Python) until the test ends.

    `-c CODE` runs in a fork that has the package loaded; `fresh=True` or an environment of its own
    starts a Python for it.
    """
    started: list[Process] = []

    def start(*arguments: str, fresh: bool = False, **environment: str) -> Process:
        log = tmp_path / f"process{len(started)}.log"
        option, *words = arguments
        if option == "-c" and not fresh and not environment:
            code, *words = words
            started.append(Process.forked(loaded_python, code, words, log))
        else:
            started.append(Process([sys.executable, *arguments], log, **environment))
        return started[-1]

    yield start
    for process in started:
        process.end()


@pytest.fixture
def start_node(start_process):
    """Return a function that runs the executable of a variant: `start_node("apf", "-p", ...)`."""

    def start(variant: str, *ros_arguments: str, fresh=False, **environment: str) -> Process:
        code = (
            "from vehicle_pf_tracker.ros.executables import main;"
            f"raise SystemExit(main({variant!r}))"
        )
        words = ["--ros-args", *ros_arguments] if ros_arguments else []
        return start_process("-c", code, *words, fresh=fresh, **environment)

    return start


@pytest.fixture(scope="session")
def messages(tmp_path_factory):
    """Return a function that imports one of the packages' modules of messages."""
    folder = tmp_path_factory.mktemp("messages")
    before = list(sys.path)
    for package, definitions in (("vision_msgs", VISION), ("tf2_msgs", TF2)):
        if find_spec(package) is None:
            if reason := missing():
                pytest.skip(f"{package} is not installed, and cannot be built: {reason}")
            sys.path.append(str(build(package, definitions, folder)))
    yield lambda package: import_module(f"{package}.msg")
    sys.path[:] = before
