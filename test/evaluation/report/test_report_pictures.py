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

"""Stills, overlays and figures, each by itself."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.plots import stretches
from vehicle_pf_tracker.evaluation.report.figures import (
    COLOURS,
    LEAST_ERROR,
    Drawn,
    draw_errors,
)
from vehicle_pf_tracker.evaluation.report.filmstrip import (
    HEIGHT,
    WIDTH,
    colour_of,
    draw_still,
    film_strips,
    longest_occlusions,
    take_frames,
    view_of,
)
from vehicle_pf_tracker.evaluation.report.page import svg_element
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder, typical

BOX = Box(100, 60, 20, 10)


def truths(text):
    """Truth from frame 1 on, by a letter each: n none, p partial, t total, - unknown."""
    kinds = {"n": Occlusion.NONE, "p": Occlusion.PARTIAL, "t": Occlusion.TOTAL}
    return {n: Truth(n, BOX, kinds[c]) for n, c in enumerate(text, start=1) if c != "-"}


def test_the_longest_occlusions_in_order():
    assert longest_occlusions(truths("nnpttpnnpn")) == [(3, 6), (9, 9)]
    many = truths("nptn" + "npn" * 9)
    assert longest_occlusions(many)[0] == (2, 3)
    assert len(longest_occlusions(many)) == 4
    assert longest_occlusions(truths("nnn")) == []


def test_stretches_of_one_kind():
    assert stretches(truths("npttpn"), {Occlusion.TOTAL}) == [(3, 4)]
    assert stretches(truths("npttpn"), {Occlusion.PARTIAL}) == [(2, 2), (5, 5)]


def test_a_view_holds_the_boxes_and_stays_in_the_image():
    left, top, width, height = view_of([BOX, Box(5, 5, 20, 10)], (320, 240))
    assert left <= 5 and top <= 5
    assert left + width >= 120 and top + height >= 70
    assert view_of([BOX, Box(-900, 5, 20, 10)], (320, 240)) == (0, 0, 320, 240)


@pytest.mark.parametrize("size", [(96, 64), (640, 360), (40, 400)])
def test_views_are_four_to_three_in_every_image(size):
    left, top, width, height = view_of([Box(10, 10, 8, 8)], size)
    assert width / height == pytest.approx(4 / 3, rel=0.05)
    assert 0 <= left <= size[0] - width
    assert 0 <= top <= size[1] - height


def test_a_still_has_the_boxes_where_they_are():
    frame = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)  # shown whole, as the margins reach its ends
    before = frame.copy()
    truth = Box(100, 60, 60, 40)
    image = draw_still(frame, truth, {1: Box(200, 100, 40, 40)})
    assert image.shape == frame.shape
    assert tuple(image[120, 200]) == colour_of(1)  # the middle of its left side
    assert tuple(image[60, 100]) == (255, 255, 255)  # the truth's corner
    assert tuple(image[80, 130]) == (128, 128, 128)  # and nothing inside
    assert np.array_equal(frame, before)


def test_boxes_far_outside_do_no_harm():
    frame = np.full((24, 32, 3), 128, np.uint8)
    boxes = {0: Box(1e9, -1e9, 5, 5), 2: Box(-50, -50, 1e7, 1e7)}
    assert draw_still(frame, BOX, boxes).shape == (HEIGHT, WIDTH, 3)


def test_stills_show_the_systems_with_a_style(made_evaluation):
    evaluation = score_folder(EvaluationFolder(made_evaluation))
    entry = next(one for one in evaluation.recordings if one.name == "bridge")
    runs = {label: typical(evaluation.of("bridge", label)) for label in ("pf", "ms")}
    ((title, stills),) = film_strips(entry, evaluation.truths["bridge"], runs, {"pf": 0}).items()
    assert title.startswith("Occlusion, frames 9 to 14 (total from ")
    assert all(still.alt.endswith("the true box and 1 estimated") for still in stills)
    assert all(still.data.startswith("data:image/jpeg;base64,") for still in stills)


def test_images_of_another_size_are_refused(made_evaluation):
    (entry, _) = EvaluationFolder(made_evaluation).recordings
    assert list(take_frames(entry, {2})) == [2]
    with pytest.raises(InputError, match="other images"):
        take_frames(replace(entry, width=640), {1})


def test_an_error_panel_draws_the_median_within_its_band():
    errors = np.array([[1.0, 4.0, np.nan], [3.0, 8.0, np.nan], [0.2, 6.0, np.nan]])
    axes = Figure().add_subplot()
    draw_errors(axes, errors)
    assert axes.lines[0].get_ydata()[:2].tolist() == [1, 6]
    band = axes.collections[0].get_paths()[0].vertices
    assert band[:, 1].min() == LEAST_ERROR
    assert band[:, 1].max() == 8


def test_no_two_figures_of_a_page_share_an_id():
    ids = []
    for number in range(2):
        figure = Figure()
        figure.add_subplot().plot([1, 2], [3, 4], color=COLOURS["s1"])
        svg = svg_element(Drawn(figure, "", 'a "b" & c'), number)
        assert 'aria-label="a &quot;b&quot; &amp; c"' in svg
        assert "var(--s1)" in svg and COLOURS["s1"] not in svg
        ids += [part.split('"')[0] for part in svg.split(' id="')[1:]]
    assert len(ids) == len(set(ids)) > 4
