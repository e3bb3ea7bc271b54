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

"""Figures as files for a paper: their sizes, their letters, and that they stay the same."""

import re
import shutil

import cv2
import numpy as np
import pytest
from evaluation_samples import HIDDEN, VARIANTS

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.report import FIGURE_FORMATS
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.aggregates import aggregate
from vehicle_pf_tracker.evaluation.report.figures import PAGE, PAPER
from vehicle_pf_tracker.evaluation.report.page import styled
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.evaluation.report.writing import FORMATS, write_figures

NAMES = {"intervals", "success", "precision", "normalised", *(f"errors_{name}" for name in HIDDEN)}


@pytest.fixture(scope="module")
def figures(made_evaluation, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures") / "evaluation"
    shutil.copytree(made_evaluation, folder)
    evaluation = score_folder(EvaluationFolder(folder))
    aggregates = aggregate(evaluation)
    written = write_figures(evaluation, aggregates, styled(aggregates), FIGURE_FORMATS)
    assert sorted(written) == sorted((folder / "figures").iterdir())
    return folder / "figures"


def test_every_figure_is_written_in_every_format(figures):
    assert {path.name for path in figures.iterdir()} == {
        f"{name}.{kind}" for name in NAMES for kind in FIGURE_FORMATS
    }
    assert FORMATS == FIGURE_FORMATS


@pytest.mark.parametrize("name", sorted(NAMES))
def test_figures_are_as_wide_as_a_column_or_the_page(figures, name):
    width = 7.16 if name.startswith("errors") else 3.5
    media = re.search(rb"/MediaBox \[ ?0 0 ([\d.]+) ", (figures / f"{name}.pdf").read_bytes())
    assert float(media[1]) == pytest.approx(72 * width, abs=0.5)
    svg = (figures / f"{name}.svg").read_text()
    assert float(re.search(r'width="([\d.]+)pt"', svg)[1]) == pytest.approx(72 * width, abs=0.5)
    assert cv2.imread(str(figures / f"{name}.png")).shape[1] == pytest.approx(300 * width, abs=1)


def test_letters_are_embedded_and_dark(figures):
    pdf = (figures / "success.pdf").read_bytes()
    assert b"/FontFile2" in pdf
    assert b"/Type3" not in pdf
    assert "<text" not in (figures / "success.svg").read_text()
    darkest = cv2.imread(str(figures / "success.png"), cv2.IMREAD_GRAYSCALE).min()
    assert darkest < 30


def test_no_stand_in_of_the_page_is_drawn(figures):
    assert PAPER.colours.keys() == PAGE.colours.keys()
    for path in figures.glob("*.svg"):
        text = path.read_text()
        assert not [colour for colour in PAGE.colours.values() if colour in text], path


def test_every_system_has_a_panel(figures):
    picture = cv2.imread(str(figures / "errors_free.png"))
    line = tuple(int(PAPER["accent"][place : place + 2], 16) for place in (5, 3, 1))
    columns = np.flatnonzero((picture == line).all(axis=2).any(axis=0))
    panels = 1 + int((np.diff(columns) > 40).sum())
    assert panels == len(VARIANTS)


@pytest.mark.slow
def test_the_same_folder_gives_the_same_files(figures, made_evaluation, tmp_path):
    folder = tmp_path / "evaluation"
    shutil.copytree(made_evaluation, folder)
    command = ["report", str(folder), "--no-images", "--figures", "svg,pdf,svg"]
    assert main(command) == 0
    again = folder / "figures"
    assert len(list(again.iterdir())) == 2 * len(NAMES)
    for path in again.iterdir():
        assert path.read_bytes() == (figures / path.name).read_bytes(), path.name


def test_an_unknown_format_is_named(tmp_path, capsys):
    assert main(["report", str(tmp_path), "--figures", "pdf,eps"]) == 2
    assert "'eps' is not a format of figures; choose from pdf, svg, png" in capsys.readouterr().err
