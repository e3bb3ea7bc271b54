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

"""Shading of occlusions in figures."""

from matplotlib.figure import Figure
from scoring_samples import NONE, PARTIAL, TOTAL, run_of

from reproduction.shading import shade_occlusions


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
