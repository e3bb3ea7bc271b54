# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Reading of MOTChallenge detections: what they hold, and the sentence for a bad row."""

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.detection_file import DetectionFile


@pytest.fixture
def read(tmp_path):
    def read(text):
        path = tmp_path / "det.txt"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return DetectionFile(path)

    return read


def test_rows_are_given_by_frame_in_their_order(read):
    found = read(
        "2,-1,10,20,30,40,0.5,-1,-1,-1\n"
        "1,-1,1.5,2.5,3,4,0.25,-1,-1,-1\n"
        "2,-1,11,21,31,41,0.75,-1,-1,-1\n"
    )
    assert found.of(1).boxes.tolist() == [[1.5, 2.5, 3, 4]]
    assert found.of(2).boxes.tolist() == [[10, 20, 30, 40], [11, 21, 31, 41]]
    assert found.of(2).scores.tolist() == [0.5, 0.75]
    assert found.of(2).labels == ("", "")
    assert len(found.of(3)) == 0
    assert found.notices == []


def test_blank_lines_comments_spaces_and_windows_files_are_read(read):
    found = read(
        b"\xef\xbb\xbf# frame, id\r\n\r\n 1, -1, 10, 20, 30, 40, 0.5\r\n1.0 -1 1 2 3 4\r\n"
    )
    assert found.of(1).boxes.tolist() == [[10, 20, 30, 40], [1, 2, 3, 4]]
    assert found.of(1).scores.tolist() == [0.5, 1.0]  # without a score: 1


def test_an_empty_file_sees_nothing(read):
    found = read("")
    assert len(found.of(1)) == 0


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("1,-1,10,20,30", "has 5 cells, of at least 6"),
        ("1,-1,10,20,thirty,40,1", "has 'thirty' as number 5, which is not a number"),
        ("frame,id,left,top,width,height,score", "has 'frame' as number 1, which is not a number"),
        ("0,-1,10,20,30,40,1", "has the frame 0; frames are integers from 1"),
        ("-3,-1,10,20,30,40,1", "has the frame -3;"),
        ("1.5,-1,10,20,30,40,1", "has the frame 1.5;"),
        ("nan,-1,10,20,30,40,1", "has the frame nan;"),
        ("inf,-1,10,20,30,40,1", "has the frame inf;"),
        ("1e300,-1,10,20,30,40,1", "has the frame 1e+300;"),
        ("9" * 100_000, "has 1 cells, of at least 6"),
        (",".join("x" * 100_000 for _ in range(6)), "which is not a number"),
    ],
)
def test_a_bad_row_is_named_by_its_number(read, row, said):
    with pytest.raises(InputError) as error:
        read(f"1,-1,10,20,30,40,0.5,-1,-1,-1\n\n{row}\n")
    assert "line 3 of the detections" in str(error.value)
    assert said in str(error.value)
    assert len(str(error.value)) < 400


@pytest.mark.parametrize(
    "row",
    [
        "1,-1,nan,20,30,40,1",
        "1,-1,10,inf,30,40,1",
        "1,-1,10,20,30,40,nan",
        "1,-1,10,20,-30,40,1",
        "1,-1,10,20,30,0,1",
    ],
)
def test_boxes_that_are_none_are_left_out_and_counted(read, row):
    found = read(f"1,-1,10,20,30,40,0.5\n{row}\n")
    assert found.of(1).boxes.tolist() == [[10, 20, 30, 40]]
    (notice,) = found.notices
    assert notice.startswith("1 of 2 detections")


def test_what_is_no_text_or_not_there_is_one_sentence(read, tmp_path):
    with pytest.raises(InputError, match="is not text"):
        read(b"\xff\xfe\x00\x01")
    with pytest.raises(InputError, match=r"cannot read the detections .*No such file"):
        DetectionFile(tmp_path / "none.txt")
    with pytest.raises(InputError, match="is not a regular file"):
        DetectionFile(tmp_path)


MISFITS = {
    "shares": ("1,-1,0.03,0.5,0.13,0.1,0.9\n2,-1,0.04,0.5,0.13,0.1,0.9\n", "all 2 boxes are below"),
    "one share": ("1,-1,0,0,1,1\n", "all 1 boxes are below one px"),
    "another size": ("1,-1,700,100,40,24\n2,-1,10,300,40,24\n", "no box lies in the image of 320x"),
    "left of it": ("1,-1,-90,100,40,24\n", "no box lies in the image of 320x240 px"),
    "corners": ("1,-1,10,100,50,124\n2,-1,200,160,240,184\n3,-1,204,160,244,184\n",
                "2 of 3 boxes reach beyond the image of 320x240 px"),
}  # fmt: skip


@pytest.mark.parametrize("case", MISFITS)
def test_boxes_that_do_not_fit_the_images_are_said(tmp_path, case):
    text, said = MISFITS[case]
    path = tmp_path / "det.txt"
    path.write_text(text)
    assert said in DetectionFile(path).misfit((320, 240))


def test_boxes_that_leave_the_image_fit_it(tmp_path):
    path = tmp_path / "det.txt"
    path.write_text("1,-1,10,100,40,24\n2,-1,300,100,40,24\n3,-1,279.5,215.5,41,25\n")
    assert DetectionFile(path).misfit((320, 240)) == ""


def test_decimal_commas_and_quotes_are_read(tmp_path):
    path = tmp_path / "det.txt"
    path.write_text('1;-1;10,5;100;40;24;0,9\n"2","-1","11.5","100","40","24","0.9"\n')
    detections = DetectionFile(path)
    assert detections.of(1).boxes.tolist() == [[10.5, 100, 40, 24]]
    assert detections.of(2).boxes.tolist() == [[11.5, 100, 40, 24]]
    path.write_text("1 -1 10,5 100 40 24 0,9\n")
    with pytest.raises(InputError, match="line 1 of"):
        DetectionFile(path)
