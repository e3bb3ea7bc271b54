# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page and its figures, made of results that never were."""

from dataclasses import replace

import pytest
from bench_samples import results

from benchmarks.bench.performance_page import PAGE, page, targets_table, write, write_targets
from benchmarks.bench.root import ROOT
from benchmarks.bench.targets import SPEED_TARGETS


@pytest.fixture(scope="module")
def text():
    return page(results())


def line(text, words):
    found = [one for one in text.splitlines() if words in one]
    assert len(found) == 1
    return found[0]


def test_targets_are_met_missed_or_not_measured():
    text = targets_table(results(), SPEED_TARGETS)
    assert "| 50x | met |" in line(text, "`kernel/joint512/41x31/vga/n200`")
    assert "| 50x | **missed** |" in line(text, "`kernel/joint512/41x31/vga/n1000`")
    assert "|  | not measured |" in line(text, "`kernel/three_features/41x31/vga/n200`")
    assert "| 1.1x | met |" in line(text, "`kernel/joint512/41x31/1080p-over-vga/n200`")
    assert "| 1.2x | **missed** |" in line(text, "`node/apf/without_step`")
    assert "| 900 ms | met |" in line(text, "`startup/apf/warm`")
    assert "| 2 lost | **missed** |" in line(text, "`fleet/apf/8x640x480`")


def test_every_target_has_a_row():
    text = targets_table(results(), SPEED_TARGETS)
    for target in SPEED_TARGETS:
        line(text, f"`{target.case}`")


def test_the_page_counts_the_targets_and_names_those_that_are_not_met(text):
    assert f"\n4 of {len(SPEED_TARGETS)} speed targets are met.\n" in text
    missed = line(text, "Missed: ")
    assert "`node/apf/without_step`" in missed
    assert "`startup/apf/warm`" not in missed
    assert "`kernel/three_features/41x31/vga/n200`" in line(text, "Not measured: ")


def test_costs_have_a_column_for_each_variant(text):
    assert (
        line(text, "| particles: 50 |") == "| particles: 50 | 2 ± 0.1; 0.1 ms | 4 ± 0.1; 0.3 ms |"
    )
    assert "| change | `apf` | `mfpf` |" in text


def test_steps_are_a_line_for_each_tracker(text):
    assert line(text, "| `apf` | 0.5") == "| `apf` | 0.5 | 50 ± 1 | 3 ± 0.1 | 100 % |"
    assert line(text, "| kcf itself |") == "| kcf itself | 1.5 |  |  | 50 % |"


def test_the_page_says_what_is_dearer_than_on_the_last_one(text):
    assert "There was no page to compare with." in text
    assert "No step takes more than 1.1 times as long" in page(results(), text)
    slower = results()
    slower.cases = [
        replace(case, ratio=case.ratio / 1.5) if case.name.startswith("step/") else case
        for case in slower.cases
    ]
    assert line(page(slower, text), "| 1.50 |") == "| `apf` | 1.50 |"


def test_the_table_of_dearer_steps_is_returned_for_the_terminal(tmp_path):
    assert "There was no page" in write(results(), tmp_path)
    assert "No step takes more" in write(results(), tmp_path)


def test_each_kernel_has_its_share_of_the_bandwidth(text):
    row = "| `joint512/41x31/vga/n200` | 0.002 | 0.05 | 4.0 % |"
    assert line(text, "| 4.0 % |") == row


def test_long_times_have_no_power_of_ten(text):
    assert "| `startup/apf/cold` | 17820 | 900 |" in text


def test_environment_and_commands_are_told(text):
    assert "Measured 2026-11-21T14:45:22+00:00: python 3.11, load average 0.1.\n" in text
    assert "\n    python -m benchmarks.bench\n" in text


def test_the_table_of_targets_is_a_file_of_its_own(tmp_path):
    write_targets(results(), tmp_path)
    assert "`startup/apf/warm`" in (tmp_path / "targets.md").read_text(encoding="utf-8")


def test_page_and_figures_are_written_and_the_same_each_time(tmp_path):
    contents = []
    for number in range(2):
        folder = tmp_path / str(number)
        write(results(), folder)
        files = sorted(folder.rglob("*.*"))
        contents.append({path.name: path.read_bytes() for path in files})
    assert contents[0] == contents[1]
    assert set(contents[0]) == {"performance.md", "steps.svg"}
    assert b"images/performance/steps.svg" in contents[0]["performance.md"]


def test_the_page_in_the_documentation_is_of_this_version():
    described = (ROOT / "package.xml").read_text(encoding="utf-8")
    version = described.partition("<version>")[2].partition("<")[0]
    published = (ROOT / "docs" / PAGE).read_text(encoding="utf-8")
    assert f"vehicle pf tracker {version}, " in published, "run make bench on a quiet machine"
