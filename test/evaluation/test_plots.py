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

import cv2
import numpy as np
import pytest
from scoring_samples import NONE, PARTIAL, TOTAL, row, run_of, scored

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.plots import overview_figure, save
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames

FRAME = np.full((240, 320, 3), 128, np.uint8)
RUNS = {
    "one": run_of((10, 1, NONE), (4, 5, PARTIAL), (6, 30, TOTAL), (10, 2, NONE)),
    "two": run_of((10, 2, NONE), (4, 5, PARTIAL), (6, 90, TOTAL), (10, 0, NONE)),
}


def test_errors_are_drawn_by_frame_on_a_scale_that_has_a_foot():
    axes = overview_figure(FRAME, RUNS).axes[1]
    lines = {line.get_label(): line for line in axes.lines}
    assert list(lines["two"].get_xdata()) == list(range(1, 31))
    assert (lines["two"].get_ydata()[0], lines["two"].get_ydata()[-1]) == (2, 0.5)
    assert lines["one"].get_color() != lines["two"].get_color()
    assert lines["one"].get_linestyle() != lines["two"].get_linestyle()


def test_occlusions_are_shaded_once():
    axes = overview_figure(FRAME, RUNS).axes[1]
    found = []
    for patch in axes.patches:
        box = patch.get_extents().transformed(axes.transData.inverted())
        found.append((patch.get_label(), round(box.x0, 3), round(box.x1, 3)))
    assert found == [("partly hidden", 10.5, 14.5), ("hidden", 14.5, 20.5)]


def test_paths_are_dashed_exactly_where_the_vehicle_is_hidden():
    figure = overview_figure(FRAME, {"one": RUNS["one"]})
    drawn = {
        line.is_dashed(): int(np.isfinite(line.get_xdata()).sum())
        for line in figure.axes[0].lines
        if line.get_color() == "#0072B2"
        and line.get_linestyle() != "None"
        and len(line.get_xdata())
    }
    # 14 frames, 6 hidden begun at the last one seen, and 10 begun at the last one hidden.
    assert drawn == {False: 14 + 11, True: 7}


def test_a_gap_breaks_the_path():
    frames = [scored(n, None if n == 5 else 1) for n in range(1, 10)]
    figure = overview_figure(FRAME, {"one": Scores(tuple(frames))})
    drawn = next(line for line in figure.axes[0].lines if line.get_color() == "#0072B2")
    assert np.isfinite(drawn.get_xdata()).tolist() == [True] * 4 + [False] + [True] * 4


@pytest.mark.parametrize("runs", [{}, {"no truth": score_frames([row(1, 5.0), row(2, 6.0)], [])}])
def test_runs_without_truth_can_be_drawn(tmp_path, runs):
    save(overview_figure(FRAME, runs), tmp_path / "path.png")
    assert cv2.imread(str(tmp_path / "path.png")).shape[1] == 1350


def test_a_picture_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(InputError, match=r"cannot write .*missing/error\.png"):
        save(overview_figure(FRAME, RUNS), tmp_path / "missing" / "error.png")
