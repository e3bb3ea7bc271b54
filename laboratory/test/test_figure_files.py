# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures in files, and files that cannot be written."""

import cv2
import pytest
from matplotlib.figure import Figure

from laboratory.figure_files import save
from vehicle_pf_tracker.core.errors import InputError


def test_a_picture_is_written_and_one_that_cannot_be_is_named(tmp_path):
    save(Figure(figsize=(9, 5)), tmp_path / "path.png")
    assert cv2.imread(str(tmp_path / "path.png")).shape[1] == 1350
    with pytest.raises(InputError, match=r"cannot write .*missing/error\.png"):
        save(Figure(), tmp_path / "missing" / "error.png")
