# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node's parameters as one value: updates, all or nothing."""

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.trackers.registry import find_variant


@pytest.fixture
def defaults():
    return Configuration.of(find_variant("pf"))


def test_an_update_goes_to_the_table_that_has_the_name(defaults):
    values = {"sigma": 3.0, "target.width": 20.0, "queue_depth": 5, "publish.box": False}
    changed = defaults.updated(values)
    assert changed.to_mapping() == {**defaults.to_mapping(), **values}
    assert (changed.tracker.sigma, changed.session.target.width) == (3.0, 20.0)
    assert (changed.node.queue_depth, changed.node.publish.box) == (5, False)


def test_names_of_others_are_left_out(defaults):
    assert defaults.updated({"use_sim_time": True}) == defaults


def test_every_mistake_of_an_update_is_named(defaults):
    with pytest.raises(InputError) as refused:
        defaults.updated({"sigma": -1.0, "queue_depth": 0, "lost_after": 2.0})
    assert "sigma must be from 0.01 to 1000" in str(refused.value)
    assert "queue_depth must be from 1 to 10000" in str(refused.value)
    assert "lost_after" not in str(refused.value)


def test_names_are_distinct_over_the_three_tables(defaults):
    parts = [Configuration.of(find_variant("apf")), defaults]
    for configuration in parts:
        tables = [configuration.tracker, configuration.session, configuration.node]
        names = [name for table in tables for name in type(table).__dataclass_fields__]
        assert len(names) == len(set(names))


@pytest.mark.parametrize(("width", "height"), [(0.5, 20.0), (20.0, 0.5)])
def test_a_target_smaller_than_a_pixel_is_refused(defaults, width, height):
    with pytest.raises(InputError, match="smaller than one pixel"):
        defaults.updated({"target.width": width, "target.height": height})


def test_a_side_of_zero_is_no_target_yet(defaults):
    assert defaults.updated({"target.width": 20.0}).session.target.box is None
    both = defaults.updated({"target.width": 20.0, "target.height": 10.0})
    assert both.session.target.box is not None


def test_a_later_update_keeps_an_earlier_one(defaults):
    changed = defaults.updated({"sigma": 3.0, "queue_depth": 5})
    changed = changed.updated({"histogram_bits": 4, "autostart": False})
    assert (changed.tracker.sigma, changed.tracker.histogram_bits) == (3.0, 4)
    assert (changed.node.queue_depth, changed.node.autostart) == (5, False)
