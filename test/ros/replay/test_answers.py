# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from vehicle_pf_tracker.ros.replay.answers import Answers, Losses


def answer(stamp_ns):
    message = DiagnosticArray(status=[DiagnosticStatus(message="WAITING")])
    message.header.stamp.nanosec = stamp_ns
    return message


def played(answers, events):
    """Publish image n for +n, and answer it for -n."""
    for event in events:
        if event > 0:
            answers.expect(event, event)
        else:
            answers.receive(answer(-event))
    return answers.losses()


def test_answers_to_other_images_are_passed_over():
    answers = Answers()
    message = answer(5)
    answers.receive(message)
    answers.expect(1, 5)
    assert not answers.has(1)
    answers.receive(message)
    answers.receive(message)
    assert answers.has(1)
    assert answers.count == 1
    (row,) = answers.rows()
    assert (row.frame, row.stamp_ns, row.mode, row.x) == (1, 5, "WAITING", None)


@pytest.mark.parametrize(
    ("events", "losses"),
    [
        ([1, -1, 2, -2, 3, -3], Losses()),
        # Image 2 came before the answer to 1.
        ([1, 2, 3, -1, -3], Losses(busy=1)),
        # Image 2 came when the node had answered all before.
        ([1, -1, 2, 3, -3], Losses(on_the_way=1)),
        # 3 and 4 came while it was at work on 2; 6 to an idle node.
        ([1, -1, 2, 3, 4, 5, -2, -5, 6, 7, -7], Losses(busy=2, on_the_way=1)),
        ([1, 2, 3], Losses(on_the_way=3)),
        ([], Losses()),
    ],
)
def test_images_are_lost_to_a_busy_node_or_on_the_way(events, losses):
    assert played(Answers(), events) == losses


def test_losses_of_all_passes_of_a_loop_count():
    answers = Answers()
    played(answers, [1, 2, 3, -1, -3])
    answers.begin_pass()
    assert played(answers, [1, -1, 2, 3, -3]) == Losses(busy=1, on_the_way=1)


def test_the_sentence_names_each_reason_and_the_remedy():
    sentence = Losses(busy=40, on_the_way=7).sentence("/apf_tracker", 200)
    assert sentence == (
        "/apf_tracker did not answer 47 of 200 images: 40 came while it was at work on an earlier "
        "one; 7 were lost on the way, or overtaken on a busy machine. In lock-step none is lost; "
        "at a lower rate, or with a larger queue_depth of the node, fewer are"
    )
    assert "on the way" not in Losses(busy=1).sentence("/a", 2)
    assert "at work" not in Losses(on_the_way=1).sentence("/a", 2)
