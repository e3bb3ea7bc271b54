# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Folders in MOTChallenge's layout."""

import re

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence, read_table

INFO = "[Sequence]\nname=tiny\nseqLength=2\nframeRate=25\nimWidth=40\nimHeight=30\n"


@pytest.fixture
def folder(tmp_path):
    root = tmp_path / "tiny"
    for name in ("img1", "gt", "det"):
        (root / name).mkdir(parents=True)
    (root / "seqinfo.ini").write_text(INFO)
    (root / "gt" / "gt.txt").write_text("1,3,10,5,8,6,1,1,1\n2,3,11,5,8,6,1,1,0.05\n")
    (root / "det" / "one.txt").write_text("2,-1,11.5,5,8,6,0.7,-1,-1,-1\n")
    return root


def test_truth_and_detections_are_read(folder):
    sequence = read_sequence(folder)
    assert (sequence.name, sequence.frame_count, sequence.frame_rate) == ("tiny", 2, 25)
    assert sequence.size == (40, 30)
    assert sequence.truth.tolist() == [[1, 3, 10, 5, 8, 6], [2, 3, 11, 5, 8, 6]]
    assert sequence.detections["one"].tolist() == [[2, 11.5, 5, 8, 6, 0.7]]
    assert len(sequence.ignored) == 0


def test_too_little_to_see_is_hidden_unless_flags_say_otherwise(folder):
    assert read_sequence(folder).hidden.tolist() == [False, True]
    (folder / "gt" / "flags.csv").write_text("frame,id,occ,cut,made\n1,3,2,T,mask\n2,3,1,-,mask\n")
    assert read_sequence(folder).hidden.tolist() == [True, False]


def test_regions_without_truth_may_have_reasons(folder):
    (folder / "ignore.txt").write_text("# frame,left\n0,0,0,40,3,top: far\n2,1,2,3,4,no truth: 7\n")
    assert read_sequence(folder).ignored.tolist() == [[0, 0, 0, 40, 3], [2, 1, 2, 3, 4]]


def test_images_are_rgb(folder):
    for number, blue in ((1, 10), (2, 200)):
        image = np.zeros((30, 40, 3), np.uint8)
        image[..., 0] = blue
        cv2.imwrite(str(folder / "img1" / f"{number:06d}.png"), image)
    assert [frame[0, 0].tolist() for frame in read_sequence(folder).frames()] == [
        [0, 0, 10],
        [0, 0, 200],
    ]


def test_a_missing_image_is_named(folder):
    with pytest.raises(InputError, match="has no images"):
        next(read_sequence(folder).frames())
    cv2.imwrite(str(folder / "img1" / "000001.png"), np.zeros((30, 40, 3), np.uint8))
    with pytest.raises(InputError, match="tiny has no image 2"):
        list(read_sequence(folder).frames())


@pytest.mark.parametrize("fault", ["frameRate=nan", "frameRate=0", "frameRate=inf", "imWidth=-1"])
def test_numbers_of_a_sequence_are_above_zero(folder, fault):
    name = fault.partition("=")[0]
    text = re.sub(rf"{name}=\S+", fault, INFO)
    assert fault in text
    (folder / "seqinfo.ini").write_text(text)
    with pytest.raises(InputError, match=r"seqinfo\.ini .*: its numbers must be above 0"):
        read_sequence(folder)


def test_what_is_no_such_folder_is_told(tmp_path, folder):
    with pytest.raises(InputError, match=r"not a MOTChallenge folder: it has no seqinfo\.ini"):
        read_sequence(tmp_path)
    (folder / "seqinfo.ini").write_text("[Sequence]\nseqLength=2\n")
    with pytest.raises(InputError, match=r"does not describe a sequence: No option 'framerate'"):
        read_sequence(folder)
    (folder / "seqinfo.ini").write_text(INFO.replace("seqLength=2", "seqLength=two"))
    with pytest.raises(InputError, match="does not describe a sequence: invalid literal"):
        read_sequence(folder)


@pytest.mark.parametrize("line", ["1,3,10,5,8", "1,3,ten,5,8,6", "frame,id,x"])
def test_a_bad_line_is_named(tmp_path, line):
    path = tmp_path / "gt.txt"
    path.write_text(f"1,3,10,5,8,6\n{line}\n")
    with pytest.raises(InputError, match=r"line 2 of the table .*gt\.txt has"):
        read_table(path, 6)


def test_a_number_that_is_not_finite_is_refused(tmp_path):
    path = tmp_path / "gt.txt"
    path.write_text("1,3,10,5,8,6\n1,3,nan,5,8,6\n")
    with pytest.raises(InputError, match=r"line 2 of .*gt\.txt has a number that is not"):
        read_table(path, 6)


def test_an_empty_table_has_its_columns(tmp_path):
    path = tmp_path / "det.txt"
    path.write_text("\n")
    assert read_table(path, 7).shape == (0, 7)
