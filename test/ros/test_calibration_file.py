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

"""Calibration files of camera drivers, good ones and others."""

import pytest

pytest.importorskip("rclpy")

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.source_outputs import read_calibration

GOOD = """
image_width: 64
image_height: 48
camera_name: front
camera_matrix: {rows: 3, cols: 3, data: [50, 0, 32, 0, 51.5, 24, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.01, 0, 0, 0]}
"""
REST = """
rectification_matrix: {rows: 3, cols: 3, data: [0, 1, 0, 1, 0, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [40, 0, 30, 1, 0, 41, 20, 2, 0, 0, 1, 3]}
"""


def test_a_calibration_is_read_by_path_and_url(tmp_path):
    path = tmp_path / "front camera.yaml"
    path.write_text(GOOD)
    info = read_calibration(str(path))
    assert (info.width, info.height, info.distortion_model) == (64, 48, "plumb_bob")
    assert list(info.k) == [50, 0, 32, 0, 51.5, 24, 0, 0, 1]
    assert list(info.d) == [-0.1, 0.01, 0, 0, 0]
    assert list(info.r) == [1, 0, 0, 0, 1, 0, 0, 0, 1]
    assert list(info.p) == [50, 0, 32, 0, 0, 51.5, 24, 0, 0, 0, 1, 0]
    assert read_calibration(path.as_uri()) == info


def test_rectification_and_projection_are_those_of_the_file(tmp_path):
    path = tmp_path / "stereo.yaml"
    path.write_text(GOOD + REST)
    info = read_calibration(str(path))
    assert list(info.r) == [0, 1, 0, 1, 0, 0, 0, 0, 1]
    assert list(info.p) == [40, 0, 30, 1, 0, 41, 20, 2, 0, 0, 1, 3]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[]", "is not a mapping"),
        ("a: [", "calibration"),
        (GOOD.replace("64", "0"), "image_width is not an integer from 1"),
        (GOOD.replace("64", "true"), "image_width is not an integer from 1"),
        (GOOD.replace("image_height: 48", ""), "image_height is not an integer"),
        (GOOD.replace(", 24, 0", ", 24"), "camera_matrix has no data of 9 numbers"),
        (GOOD.replace("51.5", ".nan"), "camera_matrix has nan"),
        (GOOD.replace("51.5", "wide"), "camera_matrix has 'wide'"),
        (GOOD.replace("camera_matrix", "matrix"), "camera_matrix has no data"),
        (GOOD.replace("-0.1", "[]"), "distortion_coefficients has"),
    ],
)
def test_what_is_no_calibration_is_refused_in_a_sentence(tmp_path, text, said):
    path = tmp_path / "camera.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=said):
        read_calibration(str(path))


@pytest.mark.parametrize("url", ["package://mine/camera.yaml", "file://host/camera.yaml"])
def test_other_urls_are_refused(url):
    with pytest.raises(InputError, match="neither a path nor a file:///URL"):
        read_calibration(url)
