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
from evaluation_samples import HIDDEN
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
    Crop,
    Mark,
    Shot,
    colour_of,
    draw_overlay,
    longest_occlusions,
    plan_strips,
    take_stills,
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
    view = Crop.around([BOX, Box(5, 5, 20, 10)], (320, 240), 280)
    assert view.left <= 5 and view.top <= 5
    assert view.left + view.width >= 120 and view.top + view.height >= 70
    assert view.scale == pytest.approx(280 / view.width)
    far = Crop.around([BOX, Box(-900, 5, 20, 10)], (320, 240), 280)
    assert (far.left, far.top, far.width, far.height) == (0, 0, 320, 240)


@pytest.mark.parametrize("size", [(96, 64), (640, 360), (40, 400)])
def test_views_are_four_to_three_in_every_image(size):
    view = Crop.around([Box(10, 10, 8, 8)], size, 280)
    assert view.width / view.height == pytest.approx(4 / 3, rel=0.05)
    assert 0 <= view.left <= size[0] - view.width
    assert 0 <= view.top <= size[1] - view.height


def test_an_overlay_has_the_boxes_where_they_are():
    frame = np.full((240, 320, 3), 128, np.uint8)
    before = frame.copy()
    image = draw_overlay(frame, Crop(0, 0, 320, 240, 2.0), BOX, [Mark(Box(200, 100, 40, 40), 1)])
    assert image.shape == (480, 640, 3)
    assert tuple(image[240, 400]) == colour_of(1)  # the middle of its left side
    assert tuple(image[120, 200]) == (255, 255, 255)  # the truth's corner
    assert tuple(image[130, 220]) == (128, 128, 128)  # and nothing inside
    assert np.array_equal(frame, before)


def test_boxes_far_outside_do_no_harm():
    frame = np.full((24, 32, 3), 128, np.uint8)
    marks = [Mark(Box(1e9, -1e9, 5, 5), None), Mark(Box(-50, -50, 1e7, 1e7), 2)]
    assert draw_overlay(frame, Crop(0, 0, 32, 24, 10.0), None, marks).shape == (240, 320, 3)


def test_each_system_is_shown_where_it_was_worst(made_evaluation):
    evaluation = score_folder(EvaluationFolder(made_evaluation))
    runs = {label: typical(evaluation.of("bridge", label)) for label in ("pf", "ms")}
    strips = plan_strips(evaluation.truths["bridge"], runs, {"pf": 0})
    around, worst = strips.values()
    assert all(len(shot.marks) == 1 for shot in around)  # ms has no style
    hidden = {index + 1 for index in HIDDEN["bridge"]}
    for shot, run in zip(worst, runs.values(), strict=True):
        visible = [e for n, e in enumerate(run.errors, start=1) if n not in hidden]
        assert shot.frame not in hidden
        assert run.errors[shot.frame - 1] == max(visible)
        assert shot.marks[0].box == run.boxes[shot.frame - 1]


def test_stills_of_other_images_are_refused(made_evaluation):
    (entry, _) = EvaluationFolder(made_evaluation).recordings
    shot = Shot(1, "", BOX, ())
    assert take_stills(entry, [shot])[shot].data.startswith("data:image/jpeg;base64,")
    with pytest.raises(InputError, match="other images"):
        take_stills(replace(entry, width=640), [shot])


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
