# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tracking a recording offline with a road."""

import pytest
from drive import box_of, drive

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker, with_target
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.road_follower import ROAD_COLUMNS

PF = VARIANTS["pf"]
# 10 px to the metre, seen from above.
PAIRS = "0,0=0,0; 500,0=50,0; 500,500=50,50; 0,500=0,50"


def tracked(**road):
    settings = with_target(SessionParameters(road=RoadParameters(**road)), box_of(0))
    tracker = OfflineTracker(PF, PF.parameters(sigma=4.0), settings)
    return tracker, list(tracker.rows(drive()))


def test_columns_of_the_road():
    tracker, rows = tracked(pairs=PAIRS)
    columns = tracker.road_columns
    assert tuple(columns) == ROAD_COLUMNS
    assert columns["road_x"] == pytest.approx([row.x / 10 for row in rows])
    half = box_of(0).height / 2
    assert columns["road_y"] == pytest.approx([(row.y + half) / 10 for row in rows])
    assert all(one > 0 for one in columns["speed_sd_kmh"])
    assert tracker.notices == []


def test_estimates_are_the_same_to_the_bit_with_and_without():
    def positions(rows):
        return [(row.x, row.y, row.confidence, row.n_eff) for row in rows]

    without, rows = tracked()
    assert without.road_columns == {}
    assert positions(rows) == positions(tracked(pairs=PAIRS)[1])


def test_frames_outside_the_area_are_empty_and_told():
    x, y = box_of(0).centre
    corners = [(60, -40), (90, -40), (90, 40), (60, 40)]
    metres = ["0,0", "1,0", "1,1", "0,1"]
    near = "; ".join(f"{x + a},{y + b}={m}" for (a, b), m in zip(corners, metres, strict=True))
    tracker, rows = tracked(pairs=near)
    speeds = tracker.road_columns["speed_kmh"]
    assert speeds[0] is None
    count = sum(one is None for one in speeds)
    assert f"no place on the road in {count} frames: outside the calibrated area" in (
        tracker.notices
    )
    assert len(speeds) == len(rows)


@pytest.mark.parametrize("road", [{"from_camera_info": True}, {"from_tf": True}])
def test_what_comes_from_topics_is_for_nodes(road):
    road |= {"from_camera_info": True}
    values = {"pairs": PAIRS} if "from_tf" not in road else {}
    with pytest.raises(InputError, match="for nodes"):
        tracked(**values, **road)
