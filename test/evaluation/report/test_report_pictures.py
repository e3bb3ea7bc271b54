# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures, each by itself."""

import numpy as np
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.report.figures import (
    FIGURE_COLOURS,
    LEAST_ERROR,
    Drawn,
    draw_errors,
    svg_element,
)


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
        figure.add_subplot().plot([1, 2], [3, 4], color=FIGURE_COLOURS["s1"])
        svg = svg_element(Drawn(figure, "", 'a "b" & c'), number)
        assert 'aria-label="a &quot;b&quot; &amp; c"' in svg
        assert "var(--s1)" in svg and FIGURE_COLOURS["s1"] not in svg
        ids += [part.split('"')[0] for part in svg.split(' id="')[1:]]
    assert len(ids) == len(set(ids)) > 4
