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

"""Services and parameters of a replay that runs."""

import threading
import time

import pytest

pytest.importorskip("rclpy")

from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from replay_rig import COUNT, IMAGE_TOPIC, PERIOD_NS, StubTracker, record, spinning, stamps
from std_srvs.srv import Trigger

from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replaying import replay

pytestmark = pytest.mark.ros

LONG = 60.0


class Remote:
    """Someone who controls the player from another thread, while the bench spins in a third."""

    def __init__(self, bench, stub):
        self.stub = stub
        self._clients = {
            name: bench.node.create_client(Trigger, f"/bag_replay/{name}")
            for name in ("pause", "resume", "toggle_paused", "is_paused", "play_next")
        }
        self._set = bench.node.create_client(SetParameters, "/bag_replay/set_parameters")

    def call(self, name):
        return self._answer(self._clients[name], Trigger.Request())

    def set(self, name, value):
        wanted = Parameter(name, value=value).to_parameter_msg()
        return self._answer(self._set, SetParameters.Request(parameters=[wanted])).results[0]

    def await_images(self, count):
        wait_for(lambda: len(self.stub.stamps) >= count)

    @staticmethod
    def _answer(client, request):
        wait_for(client.service_is_ready)
        future = client.call_async(request)
        wait_for(future.done)
        return future.result()


def wait_for(holds):
    deadline = time.monotonic() + LONG
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.fixture
def play(bench, tmp_path):
    """Replay while `script` runs with a remote control."""
    stub = StubTracker(bench)
    recording = record(tmp_path / "bag")
    remote = Remote(bench, stub)

    def run(script, **options):
        failures = []

        def guarded():
            try:
                script(remote)
            except BaseException as error:
                failures.append(error)
                remote.call("resume")

        thread = threading.Thread(target=guarded)
        with spinning(bench):
            thread.start()
            settings = {"nodes": ("stub_tracker",), "topics": (IMAGE_TOPIC,), "set_target": False}
            report = replay(recording, ReplayOptions(**{**settings, **options}))
            thread.join(LONG)
        assert not failures, failures[0]
        return report, stub

    return run


def test_it_begins_paused_and_plays_one_after_the_other(play):
    def script(remote):
        assert remote.call("is_paused").success
        assert remote.stub.stamps == []
        assert remote.call("play_next").success
        remote.await_images(1)
        remote.call("play_next")
        remote.await_images(2)
        time.sleep(3 * PERIOD_NS * 1e-9)
        assert len(remote.stub.stamps) == 2
        assert remote.call("is_paused").message == "paused at 0.040 s of 0.360 s"
        assert remote.call("resume").success

    report, stub = play(script, start_paused=True)
    assert stub.stamps == stamps()
    assert report.frames == COUNT


def test_pause_holds_resume_goes_on_where_it_was_and_toggle_does_both(play):
    def script(remote):
        remote.await_images(2)
        refused = remote.call("play_next")
        assert (refused.success, refused.message) == (False, "the replay is not paused")
        assert remote.call("pause").success
        seen = len(remote.stub.stamps)
        time.sleep(1.0)
        assert len(remote.stub.stamps) <= seen + 1  # one may have been on its way
        assert not remote.call("resume").message.startswith("paused")
        assert remote.call("toggle_paused").message.startswith("paused")
        assert remote.call("is_paused").success
        assert remote.call("toggle_paused").message.startswith("playing")
        assert not remote.call("is_paused").success

    report, stub = play(script, rate=0.2)
    assert stub.stamps == stamps()
    assert report.seconds > 1.0


def test_the_rate_is_a_parameter(play):
    def script(remote):
        remote.await_images(1)
        assert not remote.set("rate", -1.0).successful
        assert remote.set("rate", 2.0).successful  # the last wish: the replay ends in 0.2 s now

    report, stub = play(script, rate=0.01)  # 36 s if nothing was changed
    assert stub.stamps == stamps()
    assert report.seconds < 20


def test_the_position_is_a_parameter(play):
    def script(remote):
        assert not remote.set("position", 99.0).successful
        assert remote.set("position", 0.20).successful
        remote.call("play_next")
        remote.await_images(1)
        assert remote.set("position", 0.0).successful
        remote.call("resume")

    report, stub = play(script, start_paused=True)
    assert stub.stamps == [stamps()[5], *stamps()]
    assert report.frames == COUNT + 1


def test_it_can_be_paused_in_lockstep(play):
    def script(remote):
        remote.call("play_next")
        remote.await_images(1)
        time.sleep(0.3)
        assert len(remote.stub.stamps) == 1
        remote.call("resume")

    report, stub = play(script, start_paused=True, lockstep=True)
    assert stub.stamps == stamps()
    assert report.nodes[0].answered == COUNT
