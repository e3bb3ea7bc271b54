# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Remedies for Python modules that are not installed."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping

from vehicle_pf_tracker.core.errors import InputError

EXTRAS: Mapping[str, str] = {
    **dict.fromkeys(("matplotlib", "jinja2", "optuna"), "evaluation"),
    # `evaluation` brings scipy too, and says so before.
    **dict.fromkeys(("scipy", "av", "onnxruntime", "pooch"), "video"),
    "numba": "numba",
}
"""The smallest extra that brings a module, by its name."""

_ROS_ENDINGS = ("_msgs", "_interfaces", "_srvs")
"""Endings of ROS's packages of messages, which come with ROS and not from an index."""


def remedy(module: str) -> str:
    """Return one sentence that names `module` and what to install or source."""
    name = module.partition(".")[0]
    if name == "rclpy" or name.endswith(_ROS_ENDINGS):
        how = "source ROS's setup.bash, or install the extra [ros], "
        how += "pip install 'vehicle_pf_tracker[ros]'"
    elif name in EXTRAS:
        extra = EXTRAS[name]
        how = f"install the extra [{extra}], pip install 'vehicle_pf_tracker[{extra}]'"
    else:
        how = "it belongs to every installation by pip; where the others are apt's, "
        how += "`pip install mcap lz4 zstandard rosbags rich`"
    return f"the Python module {name} is not there: {how}"


EVALUATING = frozenset({"evaluate", "tune", "merge", "report"})
"""Verbs that need the extra `evaluation`: nodes, `replay`, `run` and `import` do without it."""

EVALUATION_MODULES = ("matplotlib", "scipy", "jinja2")
"""Modules of the extra `evaluation` that each of these verbs needs."""


def check_extra(verb: str) -> None:
    """Raise at the start, not after hours of work, if the libraries of `verb` are missing."""
    for name in EVALUATION_MODULES if verb in EVALUATING else ():
        if importlib.util.find_spec(name) is None:
            raise InputError(
                f"{verb} needs the Python module {name}: install the extra [evaluation], "
                "pip install 'vehicle_pf_tracker[evaluation]', or with apt python3-matplotlib "
                "python3-scipy python3-jinja2"
            )
