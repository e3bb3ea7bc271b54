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

import pytest

from vehicle_pf_tracker.core.errors import suggestion

KNOWN = ["num_particles", "motion.sigma_w", "motion.gain", "lost_after", "target.width", "width"]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("num_particels", "num_particles"),
        ("motion.sigma", "motion.sigma_w"),
        ("sigma_w", "motion.sigma_w"),
        ("sigm", "motion.sigma_w"),
        ("motoin.gian", "motion.gain"),
        ("colour.gain", "motion.gain"),
        ("widht", "width"),
    ],
)
def test_the_nearest_name_is_suggested(name, meant):
    assert suggestion(name, KNOWN) == f" (did you mean {meant!r}?)"


@pytest.mark.parametrize("name", ["", "wings", "x.y", "zoom"])
def test_nothing_is_suggested_for_what_is_like_none(name):
    assert suggestion(name, KNOWN) == ""


def test_one_part_that_several_names_have_means_the_first():
    assert suggestion("size", ["left.size", "right.size"]) == " (did you mean 'left.size'?)"
