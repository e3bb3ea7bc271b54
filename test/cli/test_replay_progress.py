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

import io

from vehicle_pf_tracker.cli.replay import progress_view
from vehicle_pf_tracker.ros.replay.replay_options import Progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Watch:
    now = 0.0

    def __call__(self):
        return self.now


def lines(*moments):
    """Show (time, frames, position) of a recording that lasts 20 s; return what was written."""
    watch, stream = Watch(), io.StringIO()
    with progress_view(stream, watch) as show:
        for moment, frames, position in moments:
            watch.now = moment
            show(Progress(frames, position, 20.0))
    return stream.getvalue().splitlines()


def test_lines_come_two_seconds_after_the_first_frame_and_every_five():
    moments = [(100.0 + second, 1 + 10 * second, float(second)) for second in range(13)]
    assert lines(*moments) == [
        " 10%, 21 frames, 10.0 frames/s, 18 s left",
        " 35%, 71 frames, 10.0 frames/s, 13 s left",
        " 60%, 121 frames, 10.0 frames/s, 8 s left",
    ]


def test_the_time_left_is_that_of_the_present_pass_of_a_loop():
    moments = [(0.0, 1, 0.0), (1.5, 16, 20.0), (1.6, 17, 0.0), (3.6, 37, 10.0)]
    assert lines(*moments) == [" 50%, 37 frames, 10.0 frames/s, 2 s left"]


def test_quick_replays_say_nothing():
    assert lines((0.0, 1, 0.0), (1.9, 20, 20.0)) == []


def test_a_recording_of_one_moment_has_no_end_to_wait_for():
    assert lines((0.0, 1, 0.0), (6.0, 2, 0.0)) == ["2 frames, 0.2 frames/s"]


def test_a_terminal_shows_a_bar():
    watch, stream = Watch(), Terminal()
    with progress_view(stream, watch) as show:
        show(Progress(1, 0.0, 20.0))
        watch.now = 2.0
        show(Progress(41, 10.0, 20.0))
    shown = stream.getvalue()
    assert "50 %" in shown
    assert "41 frames" in shown
    assert "20.0 frames/s" in shown
