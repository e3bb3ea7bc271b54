# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The demo: which verbs it runs, what it says is missing, and that it notices a difference."""

import importlib.util
import subprocess
from pathlib import Path

import pytest

from vehicle_pf_tracker.cli import demo
from vehicle_pf_tracker.cli.main import main

HEAD = "frame,stamp_ns,x,y,width,height,mode,confidence,n_eff,step_ms\n"


def row(y, step_ms):
    return f"1,0,2.5,{y},8,6,TRACKING,0.9,,{step_ms}\n"


class Node:
    """A node that runs until it is ended."""

    def __init__(self):
        self.calls = []

    def terminate(self):
        self.calls.append("terminate")

    def wait(self):
        self.calls.append("wait")


@pytest.fixture
def chain(monkeypatch):
    """Let no verb run: keep the words of each, and write what `run` and `replay` would."""
    words, answers = [], {"run": row(3.5, 0.7), "replay": row(3.5, 0.9)}
    node = Node()

    def started(command, *, check):
        words.append(command[3:])
        verb = command[3]
        if verb in answers:
            folder = Path(command[command.index("-o") + 1])
            folder.mkdir(parents=True)
            (folder / "estimates.csv").write_text(HEAD + answers[verb])
        return subprocess.CompletedProcess(command, 0 if answers.get(verb) != "fails" else 3)

    monkeypatch.setattr(demo.subprocess, "run", started)
    monkeypatch.setattr(demo.subprocess, "Popen", lambda _command: node)
    monkeypatch.setenv("ROS_DOMAIN_ID", "17")
    return words, answers, node


def hide(monkeypatch, *modules):
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name in modules else found(name)
    )


def pretend(monkeypatch, *modules):
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: True if name in modules else found(name)
    )


@pytest.mark.parametrize(
    ("of_the_node", "status", "said"),
    [
        (row(3.5, 0.9), 0, "are those of `run`"),
        (row(3.6, 0.9), 1, "are NOT those of `run`"),
    ],
)
def test_a_node_is_fed_and_its_numbers_compared(
    tmp_path, monkeypatch, capsys, chain, of_the_node, status, said
):
    words, answers, node = chain
    answers["replay"] = of_the_node
    pretend(monkeypatch, "rclpy", "matplotlib", "scipy", "jinja2")
    assert main(["demo", "-o", str(tmp_path)]) == status
    assert [verb for verb, *_ in words] == ["synth", "run", "replay", "evaluate"]
    assert node.calls == ["terminate", "wait"]
    out = capsys.readouterr().out
    assert f"the node's numbers {said}" in out
    assert f"errors over time are in {tmp_path}/evaluation/figures/errors_recording.png" in out
    assert words[-1][-4:-2] == ["--figures", "png"]
    assert f"{tmp_path}/offline/summary.png has its key frames" in out
    assert f"+ vehicle-pf-tracker synth highway {tmp_path / 'recording'}\n" in out


def test_what_is_missing_is_left_out_and_said(tmp_path, monkeypatch, capsys, chain):
    words, _, node = chain
    hide(monkeypatch, "rclpy", "scipy")
    assert main(["demo", "-o", str(tmp_path), "--overwrite"]) == 0
    assert [verb for verb, *_ in words] == ["synth", "run"]
    assert all("--overwrite" in line for line in words)
    assert node.calls == []
    notices = capsys.readouterr().err
    assert "ROS is not installed or not sourced, so no node is run" in notices
    assert "nothing is scored without the extra [evaluation]" in notices


def test_a_verb_that_fails_ends_the_demo_and_its_node(tmp_path, monkeypatch, capsys, chain):
    _, answers, node = chain
    answers["replay"] = "fails"
    pretend(monkeypatch, "rclpy")
    assert main(["demo", "-o", str(tmp_path)]) == 1
    assert "replay ended with status 3" in capsys.readouterr().err
    assert node.calls == ["terminate", "wait"]
