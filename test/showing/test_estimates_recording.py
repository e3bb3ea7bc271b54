# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from drive import drive, truth_of

from vehicle_pf_tracker.recordings.bags.messages import deserialize
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.showing.estimates_recording import run_recording


@pytest.fixture
def recording(tmp_path):
    with RecordingWriter(tmp_path / "plain") as writer:
        for index, (stamp, frame) in enumerate(drive(3)):
            writer.write_image(stamp, frame)
            writer.write_truth(truth_of(index))
    return Recording(tmp_path / "plain")


def row(index, mode="TRACKING", x=None):
    stamp = drive(index + 1)[index][0]
    if x is None:
        return EstimateRow.without(index + 1, stamp, mode)
    return EstimateRow(index + 1, stamp, x, 20.5, 16.0, 12.0, mode, 0.5, 99.0, 1.0)


def write(folder, recording, rows):
    """Write a run with these rows, by target, beside the images of `recording`."""
    with run_recording(folder, "apf_tracker", list(rows), recording.truth()) as keep:
        for index, found in enumerate(recording.frames()):
            keep(found, {name: some[index] for name, some in rows.items()})


def read(folder, topic):
    together = Recording(folder)
    kinds = {info.name: info.type_name for info in together.topics}
    return [
        (message.stamp_ns, deserialize(memoryview(message.data), kinds[topic]))
        for message in together.messages({topic})
    ]


def test_estimates_stand_beside_images_and_truth(recording, tmp_path):
    rows = [row(0, "WAITING"), row(1, "TRACKING", 0.1 + 0.2), row(2, "LOST", 31.0)]
    write(tmp_path / "all", recording, {"car": rows})
    positions = read(tmp_path / "all", "/apf_tracker/position")
    assert [(stamp, p.point.x, p.point.y) for stamp, p in positions] == [
        (rows[1].stamp_ns, 0.1 + 0.2, 20.5),
        (rows[2].stamp_ns, 31.0, 20.5),
    ]
    modes = [m.status[0] for _, m in read(tmp_path / "all", "/apf_tracker/mode")]
    assert [m.message for m in modes] == ["WAITING", "TRACKING", "LOST"]
    assert [int(m.level) for m in modes] == [0, 0, 2]
    (_, box), _ = read(tmp_path / "all", "/apf_tracker/box")
    assert [p.x for p in box.polygon.points] == pytest.approx([-7.7, 8.3, 8.3, -7.7])


def test_annotations_are_stamped_as_their_images_and_name_the_target(recording, tmp_path):
    rows = {"car": [row(0, x=1.0), row(1, "LOST", 2.0)], "van": [row(0, "WAITING")] * 2}
    write(tmp_path / "all", Recording(recording.path), {n: [*r, r[-1]] for n, r in rows.items()})
    together = Recording(tmp_path / "all")
    (kind,) = {
        info.type_name for info in together.topics if info.name.endswith("/annotations")
    }  # fmt: skip
    assert kind == "foxglove_msgs/msg/ImageAnnotations"
    images = [found.stamp_ns for found in together.frames()]
    logged = [m.log_time_ns for m in together.messages({"/apf_tracker/car/annotations"})]
    assert logged[:2] == images[:2]
    words = [
        [text.text for text in message.texts]
        for name in rows
        for _, message in read(tmp_path / "all", f"/apf_tracker/{name}/annotations")
    ]
    assert words == [["car TRACKING 0.50"], *[[]] * 5]
