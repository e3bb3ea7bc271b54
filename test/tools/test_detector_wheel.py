# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The wheel of a detector, built from a file and installed beside the package."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytest.importorskip("pip")

from tools import detector_wheel

ROOT = Path(__file__).parents[2]


def test_a_wheel_brings_the_file_to_its_name(tmp_path):
    file = tmp_path / "yolox_nano.onnx"
    file.write_bytes(b"\x08 a network")
    wheel, verdict = detector_wheel.build(file, tmp_path / "dist")
    assert "is not the sum that others state" in verdict
    with zipfile.ZipFile(wheel) as opened:
        names = opened.namelist()
        opened.extractall(tmp_path / "site")
        (notice,) = (opened.read(name).decode() for name in names if name.endswith("NOTICE"))
    assert "vehicle_pf_detector/yolox_nano.onnx" in names
    assert any(name.endswith("LICENSE") for name in names)
    assert "Megvii" in notice and verdict in notice
    code = "from vehicle_pf_tracker.following.networks.model_files import model_file; "
    code += "print(model_file('yolox-nano')[0])"
    path = os.pathsep.join([str(ROOT), str(tmp_path / "site")])
    found = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    place = tmp_path / "site" / "vehicle_pf_detector" / "yolox_nano.onnx"
    assert found.stdout.strip() == str(place)


def test_a_file_of_another_name_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"net\.onnx is none of yolox_nano\.onnx"):
        detector_wheel.build(tmp_path / "net.onnx", tmp_path)
