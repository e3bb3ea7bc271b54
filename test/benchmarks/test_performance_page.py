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

"""The page and its figures, made of results that never were."""

import pytest
from bench_samples import results

from benchmarks.bench.performance_page import page, write
from benchmarks.bench.targets import TARGETS


@pytest.fixture(scope="module")
def text():
    return page(results())


def line(text, words):
    found = [one for one in text.splitlines() if words in one]
    assert len(found) == 1
    return found[0]


def verdict(text, case):
    section = text.partition("## Targets and results")[2].partition("\n## ")[0]
    return line(section, f"`{case}`")


def test_targets_are_met_missed_or_not_measured(text):
    assert "| 50x | met |" in verdict(text, "kernel/joint512/41x31/vga/n200")
    assert "| 50x | **missed** |" in verdict(text, "kernel/joint512/41x31/vga/n1000")
    assert "|  | not measured |" in verdict(text, "kernel/three_features/41x31/vga/n200")
    assert "| 1.1x | met |" in verdict(text, "kernel/joint512/41x31/1080p-over-vga/n200")
    assert "| 1.2x | **missed** |" in verdict(text, "node/apf/without_step")
    assert "| 900 ms | met |" in verdict(text, "startup/apf/warm")
    assert "| 2 lost | **missed** |" in verdict(text, "fleet/apf/8x640x480")


def test_every_target_is_told_once(text):
    for target in TARGETS:
        verdict(text, target.case)


def test_steps_are_a_line_for_each_tracker(text):
    assert line(text, "| `apf` |") == "| `apf` | 0.5 | 50 ± 1 | 3 ± 0.1 | 100 % |"
    assert line(text, "| kcf itself |") == "| kcf itself | 1.5 |  |  | 50 % |"


def test_the_share_of_numba_is_told(text):
    assert "Of a warm start's 900 ms, numba and its kernels take 480 ms." in text


def test_environment_and_commands_are_told(text):
    assert "| load average | 0.1 |" in text
    assert "\n    python -m benchmarks.bench\n" in text


def test_page_and_figures_are_written_and_the_same_each_time(tmp_path):
    contents = []
    for _ in range(2):
        write(results(), tmp_path / "docs")
        files = sorted((tmp_path / "docs").rglob("*.*"))
        contents.append({path.name: path.read_bytes() for path in files})
    assert contents[0] == contents[1]
    assert set(contents[0]) == {"performance.md", "kernels.svg", "steps.svg"}
    for name in ("kernels.svg", "steps.svg"):
        assert f"images/performance/{name}".encode() in contents[0]["performance.md"]
