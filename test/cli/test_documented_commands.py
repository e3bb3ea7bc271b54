# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Every command line on a page is one that the command takes, and the Python example runs."""

import re
import shlex
from pathlib import Path

import cv2
import numpy as np
import pytest

import vehicle_pf_tracker
from vehicle_pf_tracker.cli.main import _parser
from vehicle_pf_tracker.core.errors import InputError

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
PROGRAM = "    vehicle-pf-tracker "
LINES = [
    line.partition("#")[0].strip()
    for page in PAGES
    for line in page.read_text().splitlines()
    if line.startswith(PROGRAM) and not {"…", "$"} & set(line)
]


@pytest.mark.parametrize("line", LINES)
def test_the_command_is_understood(line):
    words = [word for word in shlex.split(line)[1:] if word != "&"]
    assert _parser(words).parse_args(words).command[1:] == words


def test_there_are_such_commands():
    used = {line.split()[1] for line in LINES}
    assert used >= {"import", "evaluate", "tune", "replay", "run"}


def test_the_readme_example_follows_a_vehicle(tmp_path, monkeypatch, capsys):
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    road = np.random.default_rng(0).integers(90, 120, (240, 320, 3), np.uint8)
    writer = cv2.VideoWriter(
        str(tmp_path / "traffic.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), 25.0, (320, 240)
    )
    for index in range(8):
        image = cv2.GaussianBlur(road, (0, 0), 2)
        cv2.rectangle(image, (15 + 3 * index, 180), (57 + 3 * index, 203), (40, 40, 200), -1)
        cv2.rectangle(image, (22 + 3 * index, 184), (40 + 3 * index, 192), (240, 240, 240), -1)
        writer.write(image)
    writer.release()
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 8
    assert all(line.startswith("TRACKING") for line in lines)
    last = float(lines[-1].split("(")[1].split(",")[0])
    assert last == pytest.approx(36.5 + 21, abs=3)


def test_public_names_are_those_listed():
    assert {name: getattr(vehicle_pf_tracker, name) for name in vehicle_pf_tracker.__all__}
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = vehicle_pf_tracker.nothing


@pytest.mark.parametrize(
    ("variant", "parameters", "words"),
    [
        ("fussion", {}, "(did you mean 'fusion'?)"),
        ("apf_tracker", {}, "(did you mean 'apf'?)"),
        ("csrt", {}, "choose one of apf, pf"),
        ("pf", {"num_particle": 3}, "num_particle"),
        ("pf", {"num_particles": 0}, "num_particles must be"),
    ],
)
def test_mistakes_in_making_a_tracker_are_named(variant, parameters, words):
    with pytest.raises(InputError, match=re.escape(words)):
        vehicle_pf_tracker.make_tracker(variant, **parameters)
