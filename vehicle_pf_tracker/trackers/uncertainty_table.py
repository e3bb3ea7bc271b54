# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Calibration of covariances, written by `python -m laboratory.uncertainty fit`."""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread

_SPREADS: Mapping[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "*": ((10.94, 0.1711, 37.1, 0.4957), (4.045, 0.8775, 0.1824, 1.176, 2.642, 0.9435)),
    "adaptive": ((6.001, 0.0774, 13.18, 11.65), (3.474, 0.1309, 4.196, 2.088, 1.462, 0.9937)),
    "apf": ((6.896, 0.06022, 15.11, 6.745), (1.769, 0.1534, 2.579, 1.704, 1.045, 0.1282)),
    "conventional": ((6.429, 0.07983, 18.83, 13.72), (3.281, 0.119, 3.303, 1.735, 1.998, 1.122)),
    "fusion": (
        (0.1533, 0.003628, 0.138, 0.0721),
        (1.54, 0.01324, 0.01341, 0.2234, 0.6743, 0.05671),
    ),
    "hpfms": ((13.17, 0.06065, 11.51, 13.07), (1.302, 0.1016, 2.13, 1.796, 2.166, 0.7532)),
    "mfpf": ((24.98, 0.1403, 81.31, 16.89), (2.437, 5.471, 0.9005, 2.394, 3.057, 2.754)),
    "ms": ((7.213, 1.017, 14.45, 7.195), (1.533, 0.3102, 1.306, 1.514, 2.09, 1.145)),
    "pf": ((6.272, 0.05425, 12.22, 7.675), (1.612, 0.1639, 3.337, 1.591, 2.277, 0.8387)),
    "pfcl": ((6.088, 0.05398, 11.47, 7.253), (1.358, 0.1261, 2.664, 1.378, 2.024, 0.79)),
    "sapf": ((6.334, 0.07515, 19.55, 9.431), (0.1308, 0.1466, 3.307, 1.434, 1.99, 0.8813)),
    "sfpf_color": ((13.58, 0.1459, 62.73, 16.01), (1.56, 3.327, 0.5304, 1.56, 1.43, 1.491)),
    "sfpf_edge": ((19.1, 0.1297, 19.34, 5.374), (0.19, 2.588, 0.1605, 2.775, 0.167, 0.09708)),
    "sfpf_texture": ((17.49, 0.1597, 59.94, 16.74), (1.837, 0.7951, 11.44, 0.028, 1.67, 0.004093)),
}
"""`Spread` while visible and otherwise, by variant; `*` serves those that are not in it."""

CALIBRATIONS: Mapping[str, Calibration] = {
    name: Calibration(Spread(*visible), Spread(*hidden))
    for name, (visible, hidden) in _SPREADS.items()
}
