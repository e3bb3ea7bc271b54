# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import os

import cv2
import numpy as np
import pytest
from drive import box_of, drive

from vehicle_pf_tracker import __version__
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker, with_target
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.results.output_files import write_json, write_text
from vehicle_pf_tracker.results.run_folder import describe_target_run, write_run
from vehicle_pf_tracker.trackers.registry import VARIANTS

PF = VARIANTS["pf"]


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def done():
    tracker = OfflineTracker(
        PF, PF.parameters(seed=-1), with_target(SessionParameters(), box_of(0))
    )
    rows = list(tracker.rows(drive(4)))
    source = "bag", "/camera/image_raw", ("a note",)
    described = describe_target_run(tracker.session, tracker.start_frame, ("run", "bag"), *source)
    return rows, described, tracker


def test_run_info_has_all_that_makes_the_run_again(done):
    _, described, tracker = done
    assert described["variant"] == "pf"
    assert described["command"] == ["run", "bag"]
    assert (described["recording"], described["image_topic"]) == ("bag", "/camera/image_raw")
    assert described["parameters"]["seed"] == -1
    assert described["seed"] == tracker.session.tracker.seed >= 0
    assert described["parameters"]["likelihood.sigma_v"] == 0.158
    assert described["parameters"]["target.width"] == 16.0
    assert described["target"] == [8.0, 24.0, 16.0, 12.0]
    assert (described["start_frame"], described["notices"]) == (1, ["a note"])
    versions = described["versions"]
    assert versions["vehicle_pf_tracker"] == __version__
    assert (versions["numpy"], versions["opencv"]) == (np.__version__, cv2.__version__)


def test_the_drawn_seed_repeats_the_run(done):
    rows, described, _ = done
    settings = with_target(SessionParameters(), box_of(0))
    again = OfflineTracker(PF, PF.parameters(seed=described["seed"]), settings).rows(drive(4))
    assert [row.position for row in again] == [row.position for row in rows]


def test_metrics_of_an_earlier_run_are_not_left_beside_a_new_one(tmp_path, done):
    rows, described, _ = done
    (tmp_path / "metrics.json").write_text("{}")
    (tmp_path / "notes.txt").write_text("mine")
    write_run(tmp_path, rows, described)
    assert names_in(tmp_path) == ["estimates.csv", "notes.txt", "run.json"]


def test_a_file_in_the_place_of_the_folder_is_named(tmp_path):
    (tmp_path / "out").write_text("")
    with pytest.raises(InputError, match=r"the output .*out is a file; name a folder"):
        write_run(tmp_path / "out", [], {})
    with pytest.raises(InputError, match=r"cannot write .*below: Not a directory"):
        write_run(tmp_path / "out" / "below", [], {})


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_is_named(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(InputError, match="Permission denied"):
        write_run(tmp_path, [], {})
    with pytest.raises(InputError, match="Permission denied"):
        write_run(tmp_path / "new", [], {})


def test_a_file_stays_as_it_was_when_writing_fails(tmp_path):
    path = tmp_path / "run.json"
    write_text(path, "before")
    with pytest.raises(ValueError, match="JSON"):
        write_json(path, {"rate": float("nan")})
    with pytest.raises(UnicodeEncodeError):
        write_text(path, "\ud800")
    assert path.read_text() == "before"
    assert names_in(tmp_path) == ["run.json"]
