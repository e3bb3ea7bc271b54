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
import time

from vehicle_pf_tracker.cli.work_progress import stages, telling
from vehicle_pf_tracker.offline.processes import Progress


def told(*progresses):
    now = iter(range(0, 1000, 10))
    stream = io.StringIO()
    with telling("apf-fig1", stream, lambda: next(now)) as on_progress:
        for progress in progresses:
            on_progress(progress)
    return stream.getvalue().splitlines()


def test_progress_tells_done_running_and_time_left():
    lines = told(
        Progress(0, 8, ("bar PF",)), Progress(4, 8, ("bar PF", "bar MS")), Progress(8, 8, ())
    )
    assert lines == [
        "apf-fig1: 0 of 8 runs done, time left unknown; running bar PF",
        "apf-fig1: 4 of 8 runs done, about 20 s left; running bar PF, bar MS",
        "apf-fig1: 8 of 8 runs done, about 0 s left",
    ]


def stage_lines(*seconds):
    """Lines of a report whose stages begin at these times."""
    now, stream = [0.0], io.StringIO()
    with stages("report", stream, lambda: now[0]) as on_stage:
        for second in seconds:
            now[0] = second
            on_stage(f"stage at {second}")
    return stream.getvalue().splitlines()


def test_stages_of_quick_work_are_not_told():
    assert stage_lines(0.0, 0.5, 1.9) == []


def test_stages_are_told_after_two_seconds_and_every_five():
    told = stage_lines(0.0, 2.0, 3.0, 6.9, 7.0, 20.0)
    assert told == ["report: stage at 2.0", "report: stage at 7.0", "report: stage at 20.0"]


def test_a_terminal_shows_the_present_stage():
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    stream = Terminal()
    with stages("report", stream) as on_stage:
        on_stage("drawing the page")
        time.sleep(0.3)  # it is drawn some times a second
    assert "report: drawing the page" in stream.getvalue()
