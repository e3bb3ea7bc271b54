# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import contextlib

import pytest

from vehicle_pf_tracker.core.errors import InputError

pytest.importorskip("rclpy")

from benchmarks import first_answer


class DeafCamera(contextlib.nullcontext):
    """Shows images to a node that answers none."""

    def first_answer(self, topic):
        raise InputError(f"the node on {topic} answers no image")

    def __enter__(self):
        return self


def test_a_node_without_an_answer_is_told_in_a_sentence(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["first_answer", "--kinds", "floor", "--rounds", "1"])
    monkeypatch.setattr(first_answer, "Camera", DeafCamera)
    monkeypatch.setattr(first_answer, "NodeProcess", lambda *_: contextlib.nullcontext())
    assert first_answer.main() == 1
    printed = capsys.readouterr()
    assert printed.err == "first_answer: the node on /bench/first answers no image\n"
    assert printed.out == ""
