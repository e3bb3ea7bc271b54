# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`run` on videos and folders, in parts, with several targets, into pictures."""

import json
import os
import re
import resource
import signal
import sys
import threading
from contextlib import contextmanager

import cv2
import numpy as np
import pytest
from small_recordings import COUNT, TARGET, box_of, frame_folder, frame_of, record, write_video

import vehicle_pf_tracker.cli.run as run_verb
from vehicle_pf_tracker.cli.console import counting
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.source_part import numbered_part
from vehicle_pf_tracker.cli.stopping import StillAtWork, Stop, Terminated, stopping
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.messages import IMAGE_ANNOTATIONS, deserialize
from vehicle_pf_tracker.recordings.bags.reader import Recording, StampedFrame
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.results.estimates import read_estimates
from vehicle_pf_tracker.showing import pictures
from vehicle_pf_tracker.showing.video_file import video_writer


@pytest.fixture
def video(tmp_path):
    """The red vehicle as a video at 25 frames/s."""
    return write_video(tmp_path / "traffic.avi", map(frame_of, range(COUNT)))


@pytest.fixture
def run(tmp_path):
    """Call `run` with pf on a source; return its exit status."""

    def call(source, *words, variant="pf"):
        out = ["-o", str(tmp_path / "out"), "--overwrite"]
        return main(["run", str(source), "--variant", variant, *out, *map(str, words)])

    return call


def estimates(folder):
    return read_estimates(folder / "estimates.csv")


def at(index):
    box = box_of(index)
    return f"{box.x:g},{box.y:g},{box.width:g},{box.height:g}"


def test_a_video_is_tracked_as_it_is(run, video, tmp_path, capsys):
    assert run(video, "--target", TARGET) == 0
    rows = estimates(tmp_path / "out")
    assert [row.stamp_ns for row in rows] == [10**9 + n * 40_000_000 for n in range(COUNT)]
    assert all(abs(row.x - box_of(n).centre[0]) < 4 for n, row in enumerate(rows))
    assert f"TRACKING 0:00.0-0:00.4; {COUNT} of {COUNT} frames tracked" in capsys.readouterr().out


def test_a_folder_and_its_import_give_the_same_estimates(run, tmp_path):
    def numbers(source):
        assert run(source) == 0
        return [(row.stamp_ns, row.x, row.y, row.confidence) for row in estimates(tmp_path / "out")]

    folder = frame_folder(tmp_path / "frames")
    assert main(["import", str(folder), str(tmp_path / "bag")]) == 0
    assert numbers(folder) == numbers(tmp_path / "bag")


@pytest.mark.parametrize(("end", "last"), [("8", 8), ("0.28s", 8), ("0.3s", 8), ("100", COUNT)])
def test_a_part_keeps_the_numbers_of_its_frames(run, video, tmp_path, end, last):
    assert run(video, "--target", at(3), "--start", 4, "--end", end) == 0
    rows = estimates(tmp_path / "out")
    assert [row.frame for row in rows] == list(range(4, last + 1))
    assert rows[0].position == box_of(3).centre


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--start", "20"), "no frame lies between --start and --end; 12 frames"),
        (("--start", "8", "--end", "7"), "no frame lies between"),
        (("--start", "0"), "neither a frame (an integer >= 1) nor a time"),
        (("--start", "fast"), "neither a frame"),
        (("--end", "nans"), "neither a frame"),
        (("--target", "0,0,4"), "is not x,y,w,h in px"),
        (("--target", "a b:0,0,4,4"), "is not [NAME][@FRAME:]x,y,w,h"),
        (("--target", "a@0:0,0,4,4"), "frames are counted from 1"),
        (("--target", "a:8,24,16,12", "--target", "a:8,24,16,12"), "two boxes in frame 1"),
        (("--target", "a@2:8,24,16,12", "--start", "3"), "tracking begins at 3"),
        (("--target", "10,100,0,30"), "smaller than one pixel"),
        (("--target", "500,24,16,12"), "outside the image of 96x64 px"),
        (("--fps", "0"), "the frame rate (fps) in --fps must be a number from"),
        (("--video", "out.gif", "--target", TARGET), "must end in .mp4"),
        (("--targets", "none.yaml"), "cannot read the targets none.yaml"),
        ((), "draw a box around the vehicle with `vehicle-pf-tracker pick"),
    ],
)
def test_mistakes_are_told_in_one_line(run, video, capsys, words, told):
    assert run(video, *words) in (1, 2)
    error = capsys.readouterr().err.splitlines()[-1]
    assert told in error


def test_several_vehicles_in_one_pass(run, video, tmp_path, capsys):
    words = ("--target", f"red:{TARGET}", "--target", f"@5:{at(4)}")
    assert run(video, *words) == 0
    out = tmp_path / "out"
    red, later = estimates(out / "red"), estimates(out / "1")
    assert [row.mode for row in later[:4]] == ["WAITING"] * 4
    assert later[4].position == box_of(4).centre
    lines = (out / "tracks.csv").read_text().splitlines()
    assert lines[0].startswith("target,frame,stamp_ns,x,y")
    assert [line.split(",")[:2] for line in lines[1:5]] == [
        ["red", "1"], ["1", "1"], ["red", "2"], ["1", "2"]
    ]  # fmt: skip
    assert len(lines) == 1 + 2 * COUNT
    alone = tmp_path / "alone"
    words = ["--variant", "pf", "-o", str(alone), "--target", TARGET]
    assert main(["run", str(video), *words]) == 0
    assert [row.position for row in estimates(alone)] == [row.position for row in red]
    assert "red: TRACKING" in capsys.readouterr().out


def test_a_target_is_corrected_in_the_middle(run, video, tmp_path):
    assert run(video, "--target", f"a:{TARGET}", "--target", "a@6:60,8,16,12") == 0
    assert estimates(tmp_path / "out")[5].position == (68.0, 14.0)


@pytest.mark.parametrize(
    "text", ["", "targets", "targets: 3", "targets: [{}]", "targets: [{box: 3}]", "a: [1]", "[1]"]
)
def test_a_broken_file_of_targets_is_named(run, video, tmp_path, capsys, text):
    path = tmp_path / "targets.yaml"
    path.write_text(text)
    assert run(video, "--targets", path) == 1
    assert "holds no targets; it must read targets:" in capsys.readouterr().err


def test_doubtful_targets_are_followed_with_a_notice(run, tmp_path, capsys):
    recording = record(tmp_path / "bag", truths=())
    assert run(recording, "--target", "8,24,3,2", "--target", "big:0,0,90,60") == 0
    error = capsys.readouterr().err
    assert "the target 8,24,3,2 is doubtful: it is only 3 x 2 px large" in error
    assert "the target 0,0,90,60 is doubtful: it covers 88% of the image" in error


def test_a_run_leaves_nothing_of_the_one_before(run, video, tmp_path):
    assert run(video, "--target", TARGET, "--target", TARGET) == 0
    assert (tmp_path / "out" / "tracks.csv").exists()
    assert run(video, "--target", TARGET) == 0
    assert not (tmp_path / "out" / "tracks.csv").exists()


def test_the_video_shows_every_frame_and_keeps_the_rate(run, video, tmp_path, capsys):
    made = tmp_path / "seen" / "made.mp4"
    assert run(video, "--target", TARGET, "--video", made, "--particles") == 0
    shown = cv2.VideoCapture(str(made))
    assert shown.get(cv2.CAP_PROP_FPS) == pytest.approx(25.0)
    frames = []
    while (frame := shown.read())[0]:
        frames.append(frame[1])
    assert len(frames) == COUNT
    assert frames[0].shape == (64, 96, 3)
    codec = int(shown.get(cv2.CAP_PROP_FOURCC)).to_bytes(4, "little")
    assert codec in (b"h264", b"avc1")


def test_a_video_takes_as_long_as_its_source(tmp_path):
    path = tmp_path / "made.mp4"
    times = [0.0, 0.04, 0.08, 0.12, 1.12, 1.16, 1.2]  # a pause of a second
    stamps = [*(10**18 + round(1e9 * time) for time in times), 5]  # a stamp that leaps
    given = enumerate((StampedFrame(stamp, frame_of(0)) for stamp in stamps), start=1)
    with pictures.Pictures(path).drawing(given) as (take, frames):
        for _, found in frames:
            take((), lambda: frame_of(0), found.frame, found.stamp_ns)
    video, last = cv2.VideoCapture(str(path)), 0.0
    while video.read()[0]:
        last = video.get(cv2.CAP_PROP_POS_MSEC)
    assert last == pytest.approx(1240, abs=1)


def test_a_run_that_fails_leaves_no_video(run, tmp_path, monkeypatch):
    folder = frame_folder(tmp_path / "frames", count=40)
    first = list(FrameFolder(folder).frames())[:36]  # after the video was begun

    def broken(_):
        yield from first
        raise InputError("the disk is gone")

    made = tmp_path / "seen" / "made.mp4"
    monkeypatch.setattr(FrameFolder, "frames", broken)
    assert run(folder, "--video", made) == 1
    assert not made.parent.exists()


def test_a_broken_image_is_rejected_and_said(run, tmp_path, capsys):
    folder = frame_folder(tmp_path / "frames", count=40)
    (folder / "img" / "000036.jpg").write_bytes(b"no image")
    assert run(folder, "--target", "9,9,12,10") == 0
    assert "000036.jpg cannot be read" in capsys.readouterr().err


@contextmanager
def little_space():
    """Let no file grow beyond 8 kB: writing fails then as it does on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8192, before[1]))
    try:
        yield
    finally:  # before pytest reports: its own output may be a file
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_video_that_finds_no_space_is_an_error_and_is_not_left(tmp_path):
    path = tmp_path / "made.mp4"
    noise = np.random.default_rng(0).integers(0, 256, (30, 120, 160, 3), np.uint8)
    with (
        little_space(),
        pytest.raises(InputError, match=f"cannot write {path}"),
        video_writer(path, (160, 120), 25.0) as write,
    ):
        for index, frame in enumerate(noise):
            write(frame, index / 25)
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def interrupts():
    """Take signals as Python does, also where a shell in the background or nohup ignores them."""
    before = {
        number: signal.signal(number, handler)
        for number, handler in (
            (signal.SIGINT, signal.default_int_handler),
            (signal.SIGHUP, signal.SIG_DFL),
        )
    }
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.usefixtures("interrupts")
def test_a_signal_is_noted_and_a_second_one_acts_as_ever():
    with stopping(stop := Stop()):
        assert not stop.came
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.came
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.usefixtures("interrupts")
@pytest.mark.parametrize(
    "words", [(), ("--start", 5)], ids=["at the first", "on the way to --start"]
)
def test_a_signal_before_the_first_image_is_no_fault_of_the_source(
    run, video, tmp_path, monkeypatch, capsys, words
):
    def signalled(word):
        os.kill(os.getpid(), signal.SIGINT)
        return counting(word)

    monkeypatch.setattr(run_verb, "counting", signalled)
    assert run(video, "--target", TARGET, *words) == 128 + signal.SIGINT
    assert capsys.readouterr().err == ""
    assert not (tmp_path / "out").exists()


def test_what_ends_a_process_ends_it_before_the_first_image_too(video):
    stop = Stop()
    stop.number = signal.SIGTERM
    with pytest.raises(Terminated):
        numbered_part(open_source(str(video)), None, None, stop, lambda *_: None)


def test_a_computation_that_does_not_end_after_a_signal_is_left():
    stop, never = Stop(), threading.Event()
    assert stop.leaving(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        stop.leaving(lambda: 1 / 0)
    stop.number = signal.SIGINT
    with pytest.raises(StillAtWork):
        stop.leaving(never.wait)
    never.set()
    assert stop.has_left


def test_other_threads_leave_the_signals_alone():
    found = []

    def work():
        with stopping(stop := Stop()):
            found.append(stop.came)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [False]


@pytest.mark.usefixtures("interrupts")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_what_was_tracked_until_a_signal_is_kept_and_said(
    run, video, tmp_path, monkeypatch, capsys, number
):
    numbered = run_verb.numbered_part

    def signalled(frames):
        for frame, found in frames:
            if frame == 6:
                os.kill(os.getpid(), number)
            yield frame, found

    def interrupted(*values):
        first, frames = numbered(*values)
        return first, signalled(frames)

    monkeypatch.setattr(run_verb, "numbered_part", interrupted)
    made = tmp_path / "made.mp4"
    assert run(video, "--target", TARGET, "--video", made) == 128 + number
    rows = estimates(tmp_path / "out")
    assert 6 <= len(rows) < COUNT
    words = f"a signal ended the run after {len(rows)} of {COUNT} frames"
    assert words in capsys.readouterr().err
    assert json.loads((tmp_path / "out" / "run.json").read_text())["notices"][-1] == words
    assert cv2.VideoCapture(str(made)).get(cv2.CAP_PROP_FRAME_COUNT) == len(rows)


def test_without_the_encoder_the_remedy_is_said_and_nothing_is_left(
    run, video, tmp_path, monkeypatch, capsys
):
    monkeypatch.setitem(sys.modules, "av", None)
    made = tmp_path / "seen" / "made.mp4"
    assert run(video, "--target", TARGET, "--video", made) == 1
    assert "pip install 'vehicle_pf_tracker[video]'" in capsys.readouterr().err
    assert not made.parent.exists()


def annotations(recording, topic):
    return [
        [text.text for text in deserialize(memoryview(message.data), IMAGE_ANNOTATIONS).texts]
        for message in recording.messages({topic})
    ]


def test_a_run_as_a_recording_has_images_estimates_and_annotations(run, video, tmp_path):
    out = tmp_path / "bag"
    words = ("--target", TARGET, "--target", f"late@5:{at(4)}", "--end", "8", "--recording", out)
    for _ in range(2):  # a recording that is there is replaced
        assert run(video, *words) == 0
    bag = Recording(out)
    rows = estimates(tmp_path / "out" / "late")
    assert [found.stamp_ns for found in bag.frames()] == [row.stamp_ns for row in rows]
    found = annotations(bag, "/pf_tracker/late/annotations")
    assert [row.mode for row in rows[:4]] == ["WAITING"] * 4 and found[:4] == [[]] * 4
    words = [f"late {row.mode} {row.confidence:.2f}" for row in rows[4:]]
    assert [text for texts in found for text in texts] == words
    assert len(list(bag.messages({"/pf_tracker/_1/box"}))) == 8
    # An image comes before its estimates, and the file is in the order of time.
    stamps = [message.log_time_ns for message in bag.messages()]
    assert stamps == sorted(stamps)


def test_a_recorded_run_of_one_target_keeps_the_truth_of_its_part(run, tmp_path):
    bag = tmp_path / "bag"
    folder = frame_folder(tmp_path / "frames")
    assert run(folder, "--start", "3", "--recording", bag) == 0
    truths, images = Recording(bag).truth(), list(Recording(bag).frames())
    assert [truth.stamp_ns for truth in truths] == [found.stamp_ns for found in images]
    assert len(images) == COUNT - 2
    assert annotations(Recording(bag), "/pf_tracker/annotations")[0][0].startswith("TRACKING")


@pytest.mark.parametrize("rate", ["999999", "0.0001", "1000", "0.1"])
def test_a_video_of_any_rate_costs_no_estimate(run, video, tmp_path, capsys, rate):
    made = tmp_path / "made.mp4"
    status = run(video, "--target", TARGET, "--fps", rate, "--video", made)
    assert "Traceback" not in capsys.readouterr().err
    assert len(estimates(tmp_path / "out")) == COUNT
    assert status == 0
    assert cv2.VideoCapture(str(made)).get(cv2.CAP_PROP_FRAME_COUNT) == COUNT


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        ("showing.video_file.Fraction", "cannot make the video"),
        ("showing.video_file.replacing", "cannot make the video"),
        ("showing.contact_sheet.write_picture", "cannot make the picture"),
        ("showing.contact_sheet.thumbnail", "cannot make the picture"),
        ("showing.estimates_recording.jpeg", "cannot make the recording"),
        ("showing.estimates_recording.RecordingWriter", "cannot make the recording"),
    ],
)
def test_a_product_that_fails_costs_itself_alone(
    run, video, tmp_path, monkeypatch, capsys, broken, told
):
    def fail(*_, **__):
        raise RuntimeError("it fails")

    products = {
        "video": tmp_path / "made.mp4",
        "picture": tmp_path / "out" / "summary.png",
        "recording": tmp_path / "bag",
    }
    words = ("--video", products["video"], "--recording", products["recording"])
    monkeypatch.setattr(f"vehicle_pf_tracker.{broken}", fail)
    assert run(video, "--target", TARGET, *words) == 1
    out, err = capsys.readouterr()
    assert told in err and err.count("it fails; all else is written") == 1
    assert "Traceback" not in err
    assert len(estimates(tmp_path / "out")) == COUNT
    notices = json.loads((tmp_path / "out" / "run.json").read_text())["notices"]
    assert [one for one in notices if told in one] == notices
    for name, path in products.items():
        assert path.exists() == (name not in told), name
        if name == "video":
            assert (f"the video is {path}" in out) == path.exists()


def test_a_disk_that_is_full_costs_the_video(run, video, tmp_path, capsys):
    noise = np.random.default_rng(0).integers(0, 256, (30, 120, 160, 3), np.uint8)
    given = enumerate((StampedFrame(n * 40_000_000, one) for n, one in enumerate(noise)), start=1)
    made = pictures.Pictures(tmp_path / "made.mp4")
    with little_space(), made.drawing(given) as (take, frames):
        for _, found in frames:
            take((), lambda found=found: found.frame, found.frame, found.stamp_ns)
    assert made.side.notices == [
        f"cannot write {tmp_path / 'made.mp4'}: File too large; all else is written"
    ]
    assert list(tmp_path.iterdir()) == [video]


def test_a_target_that_stands_while_others_drive_is_a_notice(run, tmp_path, capsys):
    def with_a_sign(index):
        frame = frame_of(index)
        frame[42:58, 70:90] = (40, 160, 60)
        return frame

    street = write_video(tmp_path / "street.avi", map(with_a_sign, range(COUNT)))
    assert run(street, "--fps", "2", "--target", f"car:{TARGET}", "--target", "70,42,20,16") == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if "has not moved" in line]
    assert notes == [
        "vehicle-pf-tracker: note: 1: frame 11: the target has not moved for 5 s while other "
        "things did: it stands, or it is not a vehicle"
    ]


def test_a_page_of_a_run_costs_no_estimate_and_keeps_its_token(run, video, tmp_path, capsys):
    words = ("--serve", "0", "--token", "a-word-of-mine")
    assert run(video, "--target", TARGET, *words) == 0
    out = capsys.readouterr().out
    assert re.search(r"open http://127\.0\.0\.1:\d+/a-word-of-mine/ in a browser on this", out)
    assert len(estimates(tmp_path / "out")) == COUNT
    assert "a-word-of-mine" not in (tmp_path / "out" / "run.json").read_text()
