# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stills of the worst frames: which they are, what they show, and that the folder keeps them."""

import json

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.aggregates import aggregate
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.evaluation.report.stills import (
    FOLDER,
    embedded_stills,
    peaks,
    worst_moments,
    write_stills,
)
from vehicle_pf_tracker.evaluation.report.writing import write_report


@pytest.fixture
def scored(evaluation_copy):
    evaluation = score_folder(EvaluationFolder(evaluation_copy))
    return evaluation, aggregate(evaluation)


def forget_recordings(folder):
    """Let the plan name recordings that are not there."""
    plan = folder / "evaluation.json"
    document = json.loads(plan.read_text())
    for source in document["recordings"]:
        source["path"] = str(folder / "gone")
    plan.write_text(json.dumps(document))


def test_peaks_are_the_largest_values_apart_from_each_other():
    values = np.zeros(100)
    values[[10, 12, 80]] = 3.0, 2.0, 1.0
    values[50] = np.nan
    found = list(peaks(np.where(np.isnan(values), -np.inf, values), 30))
    assert found[:2] == [10, 80]
    assert all(abs(a - b) > 30 for a in found for b in found if a != b)
    assert list(peaks(np.full(5, -np.inf), 30)) == []


def test_the_worst_frame_of_a_recording_is_that_of_its_first_system(scored):
    evaluation, aggregates = scored
    moments = worst_moments(evaluation, aggregates)
    for name in {one.source.name for one in moments}:
        runs = evaluation.of(name, aggregates.order[0])
        errors = np.median([run.errors for run in runs], axis=0)
        (worst, *_) = [one for one in moments if one.source.name == name]
        assert worst.error == pytest.approx(np.nanmax(errors))
        assert errors[worst.frame - 1] == worst.error
    assert {label for one in moments for label, _ in one.boxes} == set(aggregates.order)


def test_stills_show_the_frame_and_outlive_the_recording(scored, evaluation_copy):
    evaluation, aggregates = scored
    write_stills(evaluation, aggregates)
    moments = worst_moments(evaluation, aggregates)
    files = sorted(path.name for path in (evaluation_copy / FOLDER).iterdir())
    assert files == sorted(one.file for one in moments)
    picture = cv2.imread(str(evaluation_copy / FOLDER / moments[0].file))
    assert picture.shape[1] == 480
    shown = embedded_stills(evaluation, aggregates)
    assert [one["caption"] for one in shown] == [
        f"{one.source.name}, frame {one.frame}: {one.error:.0f} px" for one in moments
    ]
    assert write_report(evaluation_copy).failures == []
    before = (evaluation_copy / "report.html").read_bytes()
    assert before.count(b"data:image/jpeg") == len(moments)
    forget_recordings(evaluation_copy)
    assert write_report(evaluation_copy).failures == []
    assert (evaluation_copy / "report.html").read_bytes().count(b"data:image/jpeg") == len(moments)


def test_without_the_recordings_there_is_no_still(evaluation_copy):
    forget_recordings(evaluation_copy)
    assert write_report(evaluation_copy).failures == []
    assert "Worst frames" not in (evaluation_copy / "report.html").read_text()
