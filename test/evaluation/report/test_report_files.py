# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures for a paper, in files beside the page."""

import re
import shutil

import cv2
import pytest
from evaluation_samples import HIDDEN

from vehicle_pf_tracker.cli.main import main

FIGURES = {"success", "precision", "normalised", *(f"errors_{n}" for n in HIDDEN)}
WORDS = ["--figures", "svg,png,pdf,svg"]


@pytest.fixture(scope="module")
def written(made_evaluation, tmp_path_factory):
    folder = shutil.copytree(made_evaluation, tmp_path_factory.mktemp("files") / "evaluation")
    assert main(["report", str(folder), *WORDS]) == 0
    return folder


def test_figures_have_the_widths_of_a_paper_and_letters_that_are_embedded(written):
    folder = written / "figures"
    assert {path.stem for path in folder.iterdir()} == FIGURES
    for name in FIGURES:
        width = 7.16 if name.startswith("errors") else 3.5
        pdf, svg = (folder / f"{name}.pdf").read_bytes(), (folder / f"{name}.svg").read_text()
        media = re.search(rb"/MediaBox \[ ?0 0 ([\d.]+) ", pdf)
        size = re.search(r'width="([\d.]+)pt"', svg)
        assert float(media[1]) == float(size[1]) == pytest.approx(72 * width, abs=0.5)
        picture = cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_GRAYSCALE)
        assert picture.shape[1] == pytest.approx(300 * width, abs=1) and picture.min() < 30
        assert b"/FontFile2" in pdf and b"/Type3" not in pdf and "<text" not in svg


@pytest.mark.slow
def test_the_same_folder_gives_the_same_files(written, evaluation_copy):
    assert main(["report", str(evaluation_copy), *WORDS]) == 0
    files = list((written / "figures").iterdir())
    assert len(files) == 3 * len(FIGURES)
    for path in files:
        again = evaluation_copy / path.relative_to(written)
        assert again.read_bytes() == path.read_bytes(), path.name


def test_an_unknown_format_is_named(tmp_path, capsys):
    assert main(["report", str(tmp_path), "--figures", "pdf,eps"]) == 2
    assert "'eps' is not a format; choose from pdf, png, svg" in capsys.readouterr().err
