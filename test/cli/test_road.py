# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_recordings import record

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.parameters.road import parse_pairs
from vehicle_pf_tracker.road.plane import RoadPlane

PAIRS = ["0,0=0,0", "90,0=9,0", "90,60=9,6", "0,60=0,6"]


@pytest.fixture
def bag(tmp_path):
    return str(record(tmp_path / "bag"))


def words(pairs):
    return [word for pair in pairs for word in ("--pair", pair)]


def test_residuals_parameters_and_picture(bag, tmp_path, capsys):
    out, grid = tmp_path / "road.yaml", tmp_path / "grid.png"
    # The last pair is 1 px off in the image, 0.1 m on the road.
    pairs = [*PAIRS, "45,31=4.5,3"]
    options = ["-o", str(out), "--grid", str(grid), "--frame-id", "map"]
    assert main(["road", "calibrate", bag, *words(pairs), *options]) == 0
    text = capsys.readouterr().out
    assert "root mean square" in text
    assert "a pixel is 0.1 to 0.1 m" in text
    off = [float(line.split()[2]) for line in text.splitlines()[1:6]]
    assert 0.5 < off[4] < 1
    assert all(one < off[4] for one in off[:4])
    values = read_yaml(out, "fusion_tracker")
    assert values["road.frame_id"] == "map"
    assert parse_pairs(values["road.pairs"]) == parse_pairs(";".join(pairs))
    assert cv2.imread(str(grid)).shape == (64, 96, 3)


def test_the_file_runs(bag, tmp_path):
    out = tmp_path / "road.yaml"
    assert main(["road", "calibrate", bag, *words(PAIRS), "-o", str(out)]) == 0
    run = ["run", bag, "--variant", "pf", "--params", str(out), "-o", str(tmp_path / "out")]
    assert main(run) == 0
    header = (tmp_path / "out" / "estimates.csv").read_text().splitlines()[0]
    assert "speed_kmh" in header


def test_pairs_to_read_again_are_named(bag, capsys):
    more = ["45,0=4.5,0", "45,60=4.5,6", "0,30=0,3"]
    assert main(["road", "calibrate", bag, *words([*PAIRS, *more])]) == 0
    assert "read again" not in capsys.readouterr().err
    misread = [*PAIRS, *more[:2], "0,12=0,3"]
    assert main(["road", "calibrate", bag, *words(misread)]) == 0
    assert "read again: 0,12=0,3 is 18 px from where the others put it" in capsys.readouterr().err
    crossed = [PAIRS[0], PAIRS[1], "90,60=0,6", "0,60=9,6"]
    assert main(["road", "calibrate", bag, *words(crossed)]) == 1
    assert "read again 0,0=0,0 and 90,0=9,0, or 90,60=0,6 and 0,60=9,6" in capsys.readouterr().err


def test_pairs_from_a_file(bag, tmp_path, capsys):
    path = tmp_path / "pairs.yaml"
    rows = [f"  - {{pixel: [{p}], road: [{r}]}}" for p, r in (one.split("=") for one in PAIRS)]
    path.write_text("\n".join(["pairs:", *rows]))
    assert main(["road", "calibrate", bag, "--pairs", str(path)]) == 0
    assert "four pairs always fit exactly" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "holds no pairs; it must read pairs:"),
        ("pairs: 3", "holds no pairs; it must read pairs:"),
        ("pairs: [{pixel: [1, 2]}]", "holds no pairs; it must read pairs:"),
        ("pairs: [", "is not valid YAML"),
        ("a: &a *a", "is not valid YAML"),
    ],
)
def test_files_without_pairs(bag, tmp_path, text, sentence, capsys):
    path = tmp_path / "pairs.yaml"
    path.write_text(text)
    assert main(["road", "calibrate", bag, "--pairs", str(path)]) == 1
    assert sentence in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (words(PAIRS[:3]), 1, "at least 4 pairs"),
        (words(["0,0=0,0", "1,1=1,1", "2,2=2,2", "5,0=5,0"]), 1, "on a line"),
        (words(["0,0"]), 1, "not u,v=x,y"),
        ([*words(PAIRS), "--frame", "99"], 1, "there is no frame 99; the source has 12"),
        ([*words(PAIRS), "--distortion", "0.1,0,0,0"], 1, "needs road.intrinsics"),
        ([*words(PAIRS), "--pairs", "nowhere.yaml"], 1, "cannot read the pairs"),
    ],
)
def test_mistakes(bag, options, status, message, capsys):
    assert main(["road", "calibrate", bag, *options]) == status
    assert message in capsys.readouterr().err


def test_distortion_is_removed(bag, tmp_path, capsys):
    lens = ["--intrinsics", "100,100,48,32", "--distortion-model", "plumb_bob"]
    lens += ["--distortion=-0.2,0,0,0"]
    straight = [*PAIRS, "45,30=4.5,3"]
    assert main(["road", "calibrate", bag, *words(straight)]) == 0
    exact = capsys.readouterr().out
    assert main(["road", "calibrate", bag, *words(straight), *lens]) == 0
    assert capsys.readouterr().out != exact


def test_a_picture_of_an_unknown_kind_is_refused(bag, tmp_path, capsys):
    assert (
        main(["road", "calibrate", bag, *words(PAIRS), "--grid", str(tmp_path / "grid.xyz")]) == 1
    )
    assert "grid.xyz must end in .png or .jpg" in capsys.readouterr().err


def test_the_pairs_of_the_page_fit_each_other():
    page = (Path(__file__).parents[2] / "docs" / "road.md").read_text("utf-8")
    pairs = parse_pairs(" ".join(re.findall(r"--pair (\d\S+)", page)))
    plane = RoadPlane.of_pairs(pairs, None, margin=0.1, coarsest=1.0)
    off = plane.to_image(np.array([one.road for one in pairs])) - [one.pixel for one in pairs]
    assert off.shape == (6, 2)
    assert np.abs(off).max() < 0.5  # as well as a pixel can be read
