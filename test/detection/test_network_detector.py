# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A detector given a network that is no file: it sees one red square wherever it is."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.network_detector import NetworkDetector
from vehicle_pf_tracker.detection.parameters import DetectorParameters

SIDE = 64
CELLS = 84  # of 8, 16 and 32 px
PARAMETERS = DetectorParameters(min_score=0.5, names="car")


class RedSquare:
    """Network of YOLOv8's form that gives the box of what is red, in its first cell."""

    def __init__(self, shape=(1, 3, SIDE, SIDE), failure=None):
        self.shape = list(shape)
        self.failure = failure

    def get_inputs(self):
        return [SimpleNamespace(name="images", type="tensor(float)", shape=self.shape)]

    def get_outputs(self):
        return [SimpleNamespace(name="boxes", type="tensor(float)", shape=[1, 5, CELLS])]

    def get_modelmeta(self):
        return SimpleNamespace(custom_metadata_map={})

    def run(self, names, inputs):
        if self.failure:
            raise RuntimeError(self.failure)
        red, green, _ = inputs["images"][0]
        rows, columns = np.nonzero((red > 0.7) & (green < 0.2))
        output = np.zeros((1, 5, CELLS), np.float32)
        if rows.size:
            left, right, top, bottom = columns[0], columns[-1] + 1, rows[0], rows[-1] + 1
            box = (left + right) / 2, (top + bottom) / 2, right - left, bottom - top
            output[0, :, 0] = [*box, 0.9]
        return [output]


def test_the_box_is_given_in_pixels_of_the_image():
    frame = np.full((SIDE, 2 * SIDE, 3), 50, np.uint8)
    frame[16:32, 80:112] = 255, 0, 0
    found = NetworkDetector(RedSquare(), "made up", PARAMETERS)
    assert found.form == "YOLOv8"
    detections = found.detect(frame)
    assert detections.boxes.tolist() == [[80.0, 16.0, 32.0, 16.0]]
    assert detections.labels == ("car",)
    assert len(found.detect(np.full_like(frame, 50))) == 0


@pytest.mark.parametrize(
    ("network", "said"),
    [
        (RedSquare(shape=(1, 1, SIDE, SIDE)), "the network made up takes no images"),
        (RedSquare(shape=(4, 3, SIDE, SIDE)), "made up takes 4 images at once; export it with a"),
        (RedSquare(shape=(1, 3, 20_000, SIDE)), "made up takes images of 64x20000 px; export it"),
        (RedSquare(failure="out of\nmemory"), "made up cannot be run: out of memory"),
    ],
)
def test_errors_have_the_name_that_was_given(network, said):
    with pytest.raises(InputError, match=said):
        NetworkDetector(network, "made up", PARAMETERS)
