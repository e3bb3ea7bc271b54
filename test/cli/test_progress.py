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

from vehicle_pf_tracker.cli.console import counting


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_plain_lines_come_after_two_seconds_and_every_five():
    now, out = [0.0], io.StringIO()
    with counting("tracked", out, lambda: now[0]) as progress:
        for done in range(1, 13):
            now[0] += 1.0
            progress(done, 12)
    assert out.getvalue() == (
        "tracked 2 of 12 frames\ntracked 7 of 12 frames\ntracked 12 of 12 frames\n"
    )


def test_where_the_total_is_unknown_the_line_says_less():
    now, out = [0.0], io.StringIO()
    with counting("imported", out, lambda: now[0]) as progress:
        now[0] = 9.0
        progress(7, None)
    assert out.getvalue() == "imported 7 frames\n"


def test_a_terminal_gets_a_bar():
    out = Terminal()
    with counting("tracked", out) as progress:
        progress(3, 12)
    assert "3/12" in out.getvalue()
