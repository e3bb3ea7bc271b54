# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Forms of networks' outputs, without running any."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection import network_classes
from vehicle_pf_tracker.detection.network_outputs import class_count, decode, form_of


def zeros(*shape):
    return np.zeros(shape, np.float32)


@pytest.mark.parametrize(
    ("outputs", "size", "form", "classes"),
    [
        ({"output0": zeros(1, 84, 8400)}, (640, 640), "YOLOv8", 80),
        ({"output0": zeros(1, 5, 8400)}, (640, 640), "YOLOv8", 1),
        ({"output": zeros(1, 8400, 85)}, (640, 640), "YOLOX", 80),
        ({"output": zeros(1, 3549, 85)}, (416, 416), "YOLOX", 80),
        ({"output": zeros(1, 5040, 6)}, (640, 384), "YOLOX", 1),
        ({"output0": zeros(1, 84, 34000)}, (1280, 1280), "YOLOv8", 80),
        (
            {"num_detections": zeros(1), "detection_boxes": zeros(1, 100, 4),
             "detection_scores": zeros(1, 100), "detection_classes": zeros(1, 100)},
            (320, 320), "SSD", None,
        ),
        (
            {"boxes": zeros(10, 4), "labels": zeros(10), "scores": zeros(10)},
            (320, 320), "SSD", None,
        ),
    ],
)  # fmt: skip
def test_forms_are_told_apart(outputs, size, form, classes):
    assert form_of(outputs, *size) == form
    assert class_count(form, outputs) == classes


@pytest.mark.parametrize(
    "outputs",
    [
        {"output0": zeros(1, 300, 6)},  # without the boxes of all cells
        {"output0": zeros(1, 25200, 85)},  # YOLOv5
        {"output0": zeros(1, 4, 8400)},
        {"output0": zeros(2, 84, 8400)},
        {"output0": zeros(1000)},
        {"boxes": zeros(10, 4), "scores": zeros(10)},
    ],
)
def test_other_forms_are_refused_with_their_shapes(outputs):
    with pytest.raises(InputError, match="are not those of YOLOX") as error:
        form_of(outputs, 640, 640)
    assert all(str(value.shape) in str(error.value) for value in outputs.values())


def test_relative_boxes_of_yolox_are_placed_in_their_cells():
    output = zeros(1, 84, 6)  # of 64 x 64 px
    output[0, :, 4:] = 1
    output[0, 9, :4] = [0.25, 0.5, np.log(2), 0]  # column 1, row 1 of the cells of 8 px
    output[0, 83, :4] = [0.5, 0.5, 0, 0]  # the last of those of 32 px
    found = decode("YOLOX", {"output": output}, 64, 64)
    assert found.boxes[9] == pytest.approx([(1.25 * 8) - 8, 1.5 * 8 - 4, 16, 8])
    assert found.boxes[83] == pytest.approx([32, 32, 32, 32])


def test_the_score_of_yolox_is_that_of_an_object_and_of_its_class():
    output = zeros(1, 84, 7)
    output[0, :, 0] = 50.0  # in px
    output[0, 0, 4:] = [0.5, 0.2, 0.8]
    found = decode("YOLOX", {"output": output}, 64, 64)
    assert found.scores[0] == pytest.approx(0.4)
    assert found.classes[0] == 1


@pytest.mark.parametrize("scale", [1.0, 320.0])
def test_boxes_of_ssd_may_be_shares_or_pixels(scale):
    outputs = {
        "boxes": np.array([[0.1, 0.2, 0.3, 0.6]]) * scale,
        "labels": np.array([3]),
        "scores": np.array([0.9]),
    }
    found = decode("SSD", outputs, 320, 320)
    assert found.boxes[0] == pytest.approx([32, 64, 64, 128])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_box_with_a_number_without_meaning_scores_nothing_and_spoils_no_other(bad):
    yolov8, yolox = zeros(1, 6, 84), zeros(1, 84, 7)
    yolov8[0], yolox[0] = 40.0, 40.0  # in px; one cell's would be below 32
    yolov8[0, 0, 3] = yolox[0, 3, 0] = bad
    boxes, scores, labels = np.full((84, 4), [10.0, 20, 30, 60]), np.ones(84), np.ones(84)
    boxes[3], labels[4] = bad, bad
    ssd = {"boxes": boxes, "scores": scores, "labels": labels}
    for form, outputs in {"YOLOv8": {"o": yolov8}, "YOLOX": {"o": yolox}, "SSD": ssd}.items():
        found = decode(form, outputs, 64, 64)
        assert found.scores[3] == 0
        assert np.isfinite(found.boxes).all()
        assert (found.boxes[5] == ([10, 20, 20, 40] if form == "SSD" else [20, 20, 40, 40])).all()


def test_coco_from_one_has_its_gaps():
    names = network_classes.coco_from_one()
    assert [names[number] for number in (1, 3, 4, 6, 8, 90)] == [
        "person", "car", "motorcycle", "bus", "truck", "toothbrush",
    ]  # fmt: skip
    assert 12 not in names
    assert len(names) == 80


@pytest.mark.parametrize("text", ["", "names", "__import__('os')", "{0: ", "[" * 5000, "{'a': 1}"])
def test_odd_metadata_gives_no_names(text):
    assert network_classes.parse_metadata(text) == {}


def test_names_of_exporters_are_read():
    assert network_classes.parse_metadata("{0: 'car', 1: 'bus'}") == {0: "car", 1: "bus"}
    assert network_classes.parse_metadata("['car', 'bus']") == {0: "car", 1: "bus"}
