# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Networks in ONNX files, on pictures whose boxes are known."""

import os
import subprocess
import sys

import numpy as np
import onnx_networks as networks
import pytest
from onnx_networks import BLUE, RED

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.parameters import DetectorParameters
from vehicle_pf_tracker.following.detectors import detector_maker

GREY = 50


def detector(path, **parameters):
    pytest.importorskip("onnxruntime")
    values = {"min_score": 0.5, "input_size": networks.SIDE, **parameters}
    return detector_maker(DetectorParameters(kind="model", model=str(path), **values))()


def picture(*squares, size=(128, 64)):
    """Return a dark picture with coloured squares: (left, top, width, height, colour)."""
    frame = np.full((size[1], size[0], 3), GREY, np.uint8)
    for left, top, width, height, colour in squares:
        frame[top : top + height, left : left + width] = colour
    return frame


CAR = (80, 16, 16, 16, RED)
TRUCK = (16, 48, 16, 16, BLUE)
# In the input of 64 x 64 px, the picture of 128 x 64 px is half as large: a cell of 8 px.


@pytest.mark.parametrize(
    ("make", "form"),
    [
        (networks.yolov8, "YOLOv8"),
        (lambda path: networks.yolox(path, relative=True), "YOLOX"),
        (lambda path: networks.yolox(path, relative=False), "YOLOX"),
    ],
)
def test_boxes_come_back_in_pixels_of_the_image(tmp_path, make, form):
    found = detector(make(tmp_path / "net.onnx"))
    assert found.form == form
    detections = found.detect(picture(CAR, TRUCK))
    by_label = dict(zip(detections.labels, detections.boxes.tolist(), strict=True))
    assert by_label == {
        "car": pytest.approx([80, 16, 16, 16]),
        "truck": pytest.approx([16, 48, 16, 16]),
    }
    assert detections.scores == pytest.approx([1.0, 1.0], abs=0.01)


def test_an_upright_image_is_fitted_too(tmp_path):
    found = detector(networks.yolov8(tmp_path / "net.onnx"))
    detections = found.detect(picture((16, 80, 16, 16, RED), size=(64, 128)))
    assert detections.boxes.tolist() == [pytest.approx([16, 80, 16, 16])]


def test_ssd_is_stretched_and_numbers_classes_as_coco_does(tmp_path):
    found = detector(networks.ssd(tmp_path / "net.onnx"))
    assert found.form == "SSD"
    # 128 x 128 px into the 64 x 64 that the network was built for, both sides open in the file.
    detections = found.detect(picture((80, 16, 16, 16, RED), TRUCK, size=(128, 128)))
    by_label = dict(zip(detections.labels, detections.boxes.tolist(), strict=True))
    assert by_label == {
        "car": pytest.approx([80, 16, 16, 16]),
        "truck": pytest.approx([16, 48, 16, 16]),
    }


def test_an_open_input_has_the_size_of_the_parameter(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx", size="side")
    found = detector(path).detect(picture((80, 96, 16, 16, RED), size=(128, 128)))
    assert found.boxes.tolist() == [pytest.approx([80, 96, 16, 16])]
    with pytest.raises(InputError, match="cannot be run"):  # its cells are those of 64 x 64 px
        detector(path, input_size=128)


def test_only_the_chosen_classes_are_given(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx")
    assert detector(path, classes="truck").detect(picture(CAR, TRUCK)).labels == ("truck",)
    assert detector(path, classes="0").detect(picture(CAR, TRUCK)).labels == ("car",)
    assert len(detector(path, classes="").detect(picture(CAR, TRUCK))) == 2


def test_the_default_classes_need_not_all_be_known(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx", names=("car", "person"))
    assert detector(path).detect(picture(CAR, TRUCK)).labels == ("car",)


def test_names_may_be_given(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx", names=None)
    found = detector(path, names="van, lorry", classes="lorry")
    assert found.detect(picture(CAR, TRUCK)).labels == ("lorry",)


def test_a_network_of_one_class_needs_no_names(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx", names=None, channels=(0,))
    assert detector(path).detect(picture(CAR, TRUCK)).labels == ("",)


def test_overlapping_boxes_are_suppressed(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx")
    # Fills a cell of 16 px, and the four of 8 px in it, which overlap it by a quarter.
    large = picture((32, 32, 32, 32, RED))
    assert len(detector(path, min_score=0.6).detect(large)) == 5
    assert len(detector(path, min_score=0.6, overlap=0.2).detect(large)) == 4


def test_scores_below_the_least_are_left_out(tmp_path):
    path = networks.yolov8(tmp_path / "net.onnx")
    dim = picture((80, 16, 16, 16, (180, 0, 0)))  # mean of 180 / 255 = 0.71
    assert len(detector(path, min_score=0.7).detect(dim)) == 1
    assert len(detector(path, min_score=0.72).detect(dim)) == 0


def test_nothing_in_sight_is_no_detection(tmp_path):
    found = detector(networks.yolov8(tmp_path / "net.onnx")).detect(picture())
    assert len(found) == 0
    assert found.boxes.shape == (0, 4)


def test_the_same_image_gives_the_same_bits(tmp_path):
    found = detector(networks.yolov8(tmp_path / "net.onnx"), min_score=0.01)
    first, second = (found.detect(picture(CAR, TRUCK)) for _ in range(2))
    assert np.array_equal(first.boxes, second.boxes)
    assert np.array_equal(first.scores, second.scores)


def test_the_image_is_not_written_to_and_may_be_a_view(tmp_path):
    found = detector(networks.yolov8(tmp_path / "net.onnx"))
    whole = np.repeat(picture(CAR), 2, axis=1)
    whole.setflags(write=False)
    assert found.detect(whole[:, ::2]).labels == ("car",)


@pytest.mark.parametrize(
    ("make", "parameters", "said"),
    [
        (lambda path: path, {}, "there is no network"),
        (lambda path: path.write_bytes(b"no network") and path, {}, "cannot be loaded"),
        (networks.something_else, {}, "are not those of YOLOX, YOLOv8 or SSD"),
        (networks.yolov8, {"classes": "van"}, "has no class 'van'"),
        (networks.yolov8, {"classes": "trucks"}, "did you mean 'truck'"),
        (networks.yolov8, {"names": "a,b,c"}, "it has 2 classes, and detector.names 3 names"),
        (
            lambda path: networks.yolov8(path, names=None),
            {},
            "2 classes without names; give them with detector.names",
        ),
        (lambda path: networks.yolov8(path, size=50), {}, "net.onnx"),
    ],
)
def test_a_file_that_does_not_do_is_one_sentence(tmp_path, make, parameters, said):
    with pytest.raises(InputError) as error:
        detector(make(tmp_path / "net.onnx"), **parameters)
    assert said in str(error.value)
    assert "net.onnx" in str(error.value)
    assert "\n" not in str(error.value)


def test_without_onnx_runtime_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(InputError, match=r"vehicle_pf_tracker\[video\]"):
        detector_maker(DetectorParameters(kind="model", model=str(tmp_path / "net.onnx")))


def test_onnx_runtime_neither_keeps_an_identity_nor_reports(tmp_path):
    pytest.importorskip("onnxruntime")
    home, network = tmp_path / "home", networks.yolov8(tmp_path / "net.onnx")
    home.mkdir()
    module = "vehicle_pf_tracker.following.networks.opened_network"
    code = f"from {module} import open_network; open_network({str(network)!r})"
    left_out = {"ORT_DISABLE_TELEMETRY", "XDG_CACHE_HOME"}
    environment = {name: one for name, one in os.environ.items() if name not in left_out}
    subprocess.run([sys.executable, "-c", code], env={**environment, "HOME": str(home)}, check=True)
    assert list(home.iterdir()) == []
