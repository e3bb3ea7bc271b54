# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

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
        ("Target.Width", "target.width"),
        ("target.WIDTH", "target.width"),
    ],
)
def test_the_nearest_name_is_suggested(name, meant):
    assert suggestion(name, KNOWN) == f" (did you mean {meant!r}?)"


@pytest.mark.parametrize("name", ["", "wings", "x.y", "zoom"])
def test_nothing_is_suggested_for_what_is_like_none(name):
    assert suggestion(name, KNOWN) == ""


def test_one_part_that_several_names_have_means_the_first():
    assert suggestion("size", ["left.size", "right.size"]) == " (did you mean 'left.size'?)"
