# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Aims of a search that a command line names: objectives, and parameters searched by default.

Known without Optuna, which is loaded when the search begins.
"""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.trackers.registry import Variant

OBJECTIVES: Mapping[str, bool] = {
    **dict.fromkeys(("success_auc", "precision_auc", "on_target", "p_error_lt_15px"), True),
    "rmse_px": False,
}
"""Metrics that can be improved; True where larger is better."""


def default_search(variant: Variant) -> list[str]:
    """Return the parameters of `variant` marked as tuned, as `search_space` takes them."""
    return [
        f"{spec.name}={spec.tuned[0]:g}:{spec.tuned[1]:g}"
        if isinstance(spec.tuned, tuple)
        else spec.name
        for spec in specs(variant.parameters).values()
        if spec.tuned
    ]
