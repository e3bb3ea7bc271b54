# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Progress: a bar on a terminal, plain lines at intervals elsewhere."""

import io
import sys
from functools import partial
from types import SimpleNamespace

import pytest

from vehicle_pf_tracker.cli import console
from vehicle_pf_tracker.cli.console import counting, stages
from vehicle_pf_tracker.cli.replay import shown_replay


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def lines(monkeypatch):
    """Show (time, report) in turn; return what was written to a file."""

    def lines_of(view, reports):
        now, stream = [0.0], io.StringIO()
        monkeypatch.setattr(console, "time", SimpleNamespace(monotonic=lambda: now[0]))
        monkeypatch.setattr(sys, "stderr", stream)
        with view() as show:
            for moment, report in reports:
                now[0] = moment
                show(*report)
        return stream.getvalue().splitlines()

    return lines_of


frames = partial(counting, "tracked")
runs = partial(counting, "evaluated", "runs")
report_stages = partial(stages, "report")


def replayed(*moments):
    """Reports of a replay that lasts 20 s at (time, frames, position)."""
    return [(at, (n, where / 20 if where else None)) for at, n, where in moments]


def test_plain_lines_come_after_two_seconds_and_every_five(lines):
    assert lines(frames, [(float(done), (done, 12)) for done in range(1, 13)]) == [
        "tracked 2 of 12 frames",
        "tracked 7 of 12 frames",
        "tracked 12 of 12 frames",
    ]


def test_where_the_total_is_unknown_the_line_says_less(lines):
    assert lines(frames, [(9.0, (7, None))]) == ["tracked 7 frames"]


def test_stages_of_quick_work_are_not_told(lines):
    moments = [0.0, 1.9, 2.0, 3.0, 6.9, 7.0]
    told = lines(report_stages, [(at, (f"stage at {at}",)) for at in moments])
    assert told == ["report: stage at 2.0", "report: stage at 7.0"]


def test_a_replay_tells_its_frames(lines):
    moments = (100.0, 1, 0.0), (102.0, 21, 2.0), (106.0, 61, 6.0)
    assert lines(shown_replay, replayed(*moments)) == [
        "played 1 frame",
        "played 61 frames",
    ]


def test_a_recording_of_one_moment_has_no_end_to_wait_for(lines):
    moments = (0.0, 1, 0.0), (6.0, 2, 0.0)
    assert lines(shown_replay, replayed(*moments)) == ["played 2 frames"]


@pytest.mark.parametrize(
    ("view", "report", "shown"),
    [
        (frames, (3, 12), "tracked 3 of 12 frames"),
        (runs, (1, 2), "evaluated 1 of 2 runs"),
        (report_stages, ("drawing [a] page",), "report: drawing [a] page"),
        (shown_replay, (41, 0.5), "41 frames"),
    ],
)
def test_a_terminal_shows_a_bar(monkeypatch, view, report, shown):
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    with view() as show:
        show(*report)
    assert shown in stream.getvalue()
