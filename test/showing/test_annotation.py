# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What is drawn for each mode, by the pixels that change."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.contact_sheet import THUMB_WIDTH, ContactSheet
from vehicle_pf_tracker.showing.target_drawing import (
    MODE_COLOURS,
    Annotator,
    estimate_words,
    frame_with_targets,
)
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

BLACK = np.zeros((120, 160, 3), np.uint8)


def estimate(mode, x=80.0, y=60.0):
    return Estimate(
        (x, y), Box(x - 20, y - 10, 40, 20), (1.0, 0.0), mode, "", 0.9, {}, 1.0, 0, 0,
        particles=np.array([[20.5, 100.5]]), weights=np.ones(1),
    )  # fmt: skip


def drawn(mode, **options):
    picture = BLACK.copy()
    annotator = Annotator(**options)
    found = estimate(mode)
    annotator.follow(found)
    annotator.draw(picture, found)
    return picture


def share_of_outline(picture, colour):
    """Share of the box's upper edge that has the colour."""
    return float(np.all(picture[50, 60:101] == colour, axis=-1).mean())


def test_a_tracked_vehicle_has_a_closed_box_in_its_colour():
    picture = drawn(Mode.TRACKING)
    assert share_of_outline(picture, MODE_COLOURS["TRACKING"]) == 1.0
    assert not picture[100, 20].any()


def test_a_predicted_position_is_dashed():
    share = share_of_outline(drawn(Mode.OCCLUDED), MODE_COLOURS["OCCLUDED"])
    assert 0.4 < share < 0.8


def test_a_lost_vehicle_has_no_box():
    assert not drawn(Mode.LOST).any()


def test_words_of_two_vehicles_do_not_cover_each_other(monkeypatch):
    bottoms = {}
    note = lambda _, words, at, *rest, **how: bottoms.update({words: at[1]})  # noqa: E731
    monkeypatch.setattr(drawing, "write_words", note)
    states = []
    for name, x in (("truck", 60.0), ("car", 90.0)):
        row = EstimateRow.without(7, 0, "TRACKING")
        states.append((Annotator(name), row, estimate(Mode.TRACKING, x)))
    frame_with_targets(BLACK, None, states)
    one, other = (bottoms[f"{name} TRACKING"] for name in ("truck", "car"))
    assert abs(one - other) >= drawing.LETTER


def test_particles_are_drawn_on_request():
    assert drawn(Mode.TRACKING, particles=True)[100, 20].any()


def test_the_path_ends_where_the_vehicle_is_lost():
    annotator, picture = Annotator(), BLACK.copy()
    for x, mode in ((20, Mode.TRACKING), (50, Mode.LOST), (80, Mode.TRACKING)):
        annotator.follow(estimate(mode, float(x)))
    annotator.draw(picture, estimate(Mode.TRACKING))
    assert not picture[60, 20:55].any()


def test_a_frame_gets_its_time_and_a_line_for_each_target_and_stays_as_it_was():
    frame = BLACK.copy()
    row = EstimateRow.without(7, 0, "LOST")
    picture = frame_with_targets(frame, 1_500_000_000, [(Annotator("van"), row, None)])
    assert not frame.any()
    assert picture[:20].any() and picture[20:40].any()
    assert estimate_words("van", row) == "van LOST"


@pytest.mark.parametrize(
    ("modes", "kept"),
    [("TTTT", 2), ("T", 1), ("TTOOTT", 6), ("TOT", 3), ("TO" * 20, 12)],
)
def test_a_sheet_has_the_frames_at_changes_and_both_ends(tmp_path, modes, kept):
    sheet = ContactSheet()
    for mode in modes:
        sheet.add((mode,), lambda: np.full((120, 160, 3), 200, np.uint8))
    sheet.write(tmp_path / "sheet.png")
    picture = cv2.imread(str(tmp_path / "sheet.png"))
    columns = min(kept, 3)
    rows = -(-kept // columns)
    assert picture.shape == (rows * 300, columns * THUMB_WIDTH, 3)
    filled = (picture[150::300, THUMB_WIDTH // 2 :: THUMB_WIDTH] > 100).all(axis=-1).sum()
    assert filled == kept


def test_no_frames_make_no_sheet(tmp_path):
    ContactSheet().write(tmp_path / "sheet.png")
    assert list(tmp_path.iterdir()) == []
