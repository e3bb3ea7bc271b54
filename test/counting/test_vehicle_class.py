# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Classes of vehicles are decided once."""

import math
from dataclasses import replace

from traffic_samples import vehicle

from vehicle_pf_tracker.counting.vehicle_class import VehicleClasses
from vehicle_pf_tracker.results.traffic_results import track_files


def labels(classes, words, score=0.9):
    """Return the class of vehicle 1 as the tracker says `words`, image by image."""
    images = [replace(vehicle(1, 0, 0, label=word), score=score) for word in words]
    return [classes.named([one])[0].label for one in images]


def test_a_class_that_has_led_for_fifteen_detections_stays():
    classes = VehicleClasses()
    assert labels(classes, ["car"] * 3 + ["truck"] * 14)[-1] == "truck"
    assert classes.undecided == {1}
    assert labels(classes, ["truck", "car", "car"]) == ["truck"] * 3
    assert classes.undecided == frozenset()


def test_a_vehicle_that_is_counted_is_of_the_class_it_was_counted_as():
    classes = VehicleClasses()
    labels(classes, ["car"])
    classes.decide(1)
    assert labels(classes, ["truck"] * 40) == ["car"] * 40


def test_images_without_a_detection_decide_only_after_two_seconds():
    classes = VehicleClasses()
    assert labels(classes, ["car"] * 59, score=math.nan)[-1] == "car"
    assert labels(classes, ["bus"]) == ["bus"]
    assert labels(classes, ["car"]) == ["bus"]


def test_rows_have_one_class_from_the_first_image_on(tmp_path):
    classes = VehicleClasses()
    with track_files(tmp_path) as files:
        for frame, word in enumerate(["car"] * 4 + ["truck"] * 30, start=1):
            named = classes.named([replace(vehicle(1, 0, 0, label=word), score=0.9)])
            files.write(frame, frame, named, undecided=classes.undecided)
    rows = (tmp_path / "tracks.csv").read_text().splitlines()[1:]
    assert len(rows) == 34
    assert {row.split(",")[11] for row in rows} == {"truck"}
