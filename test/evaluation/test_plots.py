# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import cv2
import pytest
from matplotlib.figure import Figure
from scoring_samples import NONE, PARTIAL, TOTAL, run_of

from laboratory.figure_files import save
from reproduction.drawing.shading import shade_occlusions
from vehicle_pf_tracker.core.errors import InputError


def test_a_picture_is_written_and_one_that_cannot_be_is_named(tmp_path):
    save(Figure(figsize=(9, 5)), tmp_path / "path.png")
    assert cv2.imread(str(tmp_path / "path.png")).shape[1] == 1350
    with pytest.raises(InputError, match=r"cannot write .*missing/error\.png"):
        save(Figure(), tmp_path / "missing" / "error.png")


def test_occlusions_are_shaded_once():
    axes = Figure().add_subplot()
    shade_occlusions(axes, run_of((10, 1, NONE), (4, 5, PARTIAL), (6, 30, TOTAL), (10, 2, NONE)))
    spans = [
        (patch.get_label(), patch.get_extents().transformed(axes.transData.inverted()))
        for patch in axes.patches
    ]
    found = {label: (round(box.x0, 3), round(box.x1, 3)) for label, box in spans}
    assert found == {"partly hidden": (10.5, 14.5), "hidden": (14.5, 20.5)}
    assert len(spans) == 2
