# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The naive baseline measures the same thing: its numbers are ours, by every route."""

import numpy as np
import pytest

from benchmarks.bench import kernels, naive
from benchmarks.bench.material import clouds, drive, enlarged
from benchmarks.bench.routes import routes, three_references
from benchmarks.bench.targets import SPEED_TARGETS
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.window import Window

WINDOW = Window(9, 6)


@pytest.fixture(scope="module")
def sight():
    """A frame, the next one, and particles about the vehicle in it."""
    frames, boxes = drive()
    return frames[50], frames[51], clouds(boxes[51].centre, 40)[0], boxes[50].centre


@pytest.mark.parametrize("route", routes(), ids=lambda route: route.name)
def test_joint_histograms(route, sight):
    first, frame, positions, centre = sight
    histogram = naive.joint_histogram(first, *centre, WINDOW)
    assert histogram.sum() == pytest.approx(1)
    own = route.joint(frame, positions, WINDOW, Reference(histogram))
    baseline = naive.joint_similarity(frame, positions, WINDOW, histogram)
    assert np.ptp(baseline) > 0.1
    assert own == pytest.approx(baseline, abs=1e-6)


@pytest.mark.parametrize("route", routes(), ids=lambda route: route.name)
def test_three_features(route, sight):
    first, frame, positions, centre = sight
    histograms = naive.three_histograms(first, *centre, WINDOW)
    own = route.three(frame, positions, WINDOW, three_references(histograms))
    baseline = naive.three_similarities(frame, positions, WINDOW, histograms)
    assert (np.ptp(baseline, axis=1) > 0.05).all()
    assert own == pytest.approx(baseline, abs=1e-6)


def test_larger_images_hold_the_frame_and_its_mirror_images():
    frame = drive().frames[0]
    large = enlarged(frame, "1080p")
    assert large.shape == (1080, 1920, 3)
    assert (large[:480, :640] == frame).all()
    assert (large[480] == large[479]).all()
    assert enlarged(frame, "vga") is frame


def test_every_target_of_the_kernels_names_a_case():
    names = {name for route in routes() for name in kernels.contests(route)}
    wanted = {target.case for target in SPEED_TARGETS if target.case.startswith("kernel")}
    installed = tuple(f"{route.name}/" for route in routes())
    assert {name for name in wanted if name.startswith(installed)} <= names
