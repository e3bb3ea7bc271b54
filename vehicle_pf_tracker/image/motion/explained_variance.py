# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""How well flow explains an image by an earlier one."""

from __future__ import annotations

import cv2
import numpy as np

from vehicle_pf_tracker.image.correlation.gradient_cells import Grey
from vehicle_pf_tracker.image.motion.box_motion import FLOW_CELL_PX, CellBlock, Flow


def explained_variance(image: Grey, earlier: Grey, flow: Flow, cells: CellBlock) -> float:
    """Share of the variance of an image's grey levels that an earlier image explains by flow.

    The square of the correlation of both: a change of light or contrast is no error.

    Parameters
    ----------
    image, earlier : (h, w) arrays of uint8
        Grey levels.
    flow : (h, w, 2) array of float32
        Flow of `image`; see `Flow`.
    cells : (2, 2) array of intp
        The block of `image` that counts; see `CellBlock`.

    Returns
    -------
    float
        From 0 to 1; 0 where one of them is plain or has the other's levels reversed.
    """
    (left, top), (columns, rows) = (cells * FLOW_CELL_PX).tolist()
    block = slice(top, top + rows), slice(left, left + columns)
    y, x = np.mgrid[block].astype(np.float32)
    dx, dy = np.moveaxis(flow[block], 2, 0)
    # Beyond its border the earlier image goes on as it ends: a box may be half outside.
    border = cv2.BORDER_REPLICATE
    source = cv2.remap(earlier, x + dx, y + dy, cv2.INTER_LINEAR, borderMode=border)
    one = image[block] - np.mean(image[block])
    other = source - np.mean(source)
    common = float(np.vdot(one, other))
    variances = float(np.vdot(one, one)) * float(np.vdot(other, other))
    return max(common, 0.0) ** 2 / variances if variances else 0.0
