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


from vehicle_pf_tracker.offline.estimates import (
    REJECTED,
    WAITING,
    EstimateRow,
    interpolate_occlusions,
    interpolated_columns,
    read_estimates,
    write_estimates,
)


def rows(*entries):
    """Rows from (stamp in s, x, mode), y is ten times x."""
    return [
        EstimateRow(n, round(stamp * 1e9), x, None if x is None else 10 * x, 4.0, 4.0, mode,
                    1.0, 1.0, 1.0)
        for n, (stamp, x, mode) in enumerate(entries, start=1)
    ]  # fmt: skip


def xs(*entries):
    return [None if p is None else p[0] for p in interpolate_occlusions(rows(*entries))]


T, H, L = "TRACKING", "OCCLUDED", "LOST"


def test_time_divides_the_line_between_the_last_and_the_next_seen():
    points = interpolate_occlusions(
        rows((0, 0.0, T), (1, 7.0, H), (2, 7.0, L), (4, 8.0, T), (5, 9.0, T))
    )
    assert points == [(0, 0), (2, 20), (4, 40), (8, 80), (9, 90)]


def test_rejected_frames_are_filled_too():
    assert xs((0, 0.0, T), (1, None, REJECTED), (2, 4.0, T)) == [0, 2, 4]


def test_there_is_no_line_without_both_ends():
    entries = (0, None, WAITING), (1, 1.0, T), (2, 2.0, H), (3, 3.0, L)
    assert xs(*entries) == [None, 1, None, None]


def test_no_line_is_drawn_where_time_goes_back():
    assert xs((5, 0.0, T), (6, 1.0, H), (0, 4.0, T)) == [0, None, 4]
    assert xs((5, 0.0, T), (0, 1.0, H), (7, 4.0, T)) == [0, None, 4]


def test_the_columns_are_written_last_and_are_not_read_as_estimates(tmp_path):
    made = rows((0, 0.0, T), (1, 7.0, H), (2, 4.0, T))
    path = tmp_path / "estimates.csv"
    write_estimates(path, made, interpolated_columns(made))
    header, _, occluded, _ = path.read_text().splitlines()
    assert header.endswith("step_ms,x_interpolated,y_interpolated")
    assert occluded.endswith(",2.0,20.0")
    assert read_estimates(path) == made
