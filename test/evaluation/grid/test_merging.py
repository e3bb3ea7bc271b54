# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of an evaluation, run apart and joined."""

import json
import shutil
from dataclasses import replace

import pytest
from evaluation_samples import here, make_plan, results, silent, system, write_recordings

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.cells import ALL_CELLS, Part
from vehicle_pf_tracker.evaluation.grid.merging import merge
from vehicle_pf_tracker.evaluation.grid.running import complete


@pytest.fixture
def plan(tmp_path):
    return replace(make_plan(write_recordings(tmp_path / "recordings")), restart=5)


@pytest.fixture
def parts(plan, tmp_path):
    """Folders of three parts."""
    folders = [tmp_path / f"part_{number}" for number in (1, 2, 3)]
    for number, folder in enumerate(folders, start=1):
        complete(replace(plan, part=Part(number, 3)), folder, here, silent)
    return folders


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_parts_have_each_cell_once(plan, count):
    cells = [
        cell
        for number in range(1, count + 1)
        for cell in replace(plan, part=Part(number, count)).cells()
    ]
    assert sorted(map(str, cells)) == sorted(map(str, plan.cells()))


@pytest.mark.parametrize("text", ["", "0/2", "3/2", "1", "a/b", "1/0", "-1/2", "1/2/3", "1.5/2"])
def test_what_is_no_part_is_refused(text):
    with pytest.raises(InputError, match="not a part: 2/4 is the second of four"):
        Part.parse(text)


def test_a_part_is_read():
    assert Part.parse("2/4") == (2, 4)
    assert Part.parse("1/1") == ALL_CELLS


def test_joined_parts_are_the_whole(plan, parts, tmp_path):
    complete(plan, tmp_path / "whole", here, silent)
    assert merge(parts, tmp_path / "joined") == len(plan.cells()) == 6
    assert results(tmp_path / "joined") == results(tmp_path / "whole")
    assert list((tmp_path / "joined").glob("cells/*/*/*/restarted.csv"))
    assert complete(plan, tmp_path / "joined", here, silent) == 0


def test_parts_are_joined_in_one_of_them(plan, parts, tmp_path):
    complete(plan, tmp_path / "whole", here, silent)
    assert merge(parts, parts[1]) == 6
    assert results(parts[1]) == results(tmp_path / "whole")


def test_a_failed_cell_gives_way_to_a_result(plan, parts, tmp_path):
    failed = tmp_path / "failed"
    shutil.copytree(parts[0], failed)
    cell = next(failed.glob("cells/*/*/seed-*"))
    shutil.rmtree(cell)
    cell.mkdir()
    (cell / "failed.json").write_text('{"reason": "so"}')
    complete(plan, tmp_path / "whole", here, silent)
    merge([failed, *parts], tmp_path / "joined")
    assert results(tmp_path / "joined") == results(tmp_path / "whole")


def test_parts_of_two_evaluations_are_refused_by_what_differs(plan, parts, tmp_path):
    other = replace(plan, systems=[system("ms")], seeds=(0,))
    complete(other, tmp_path / "other", here, silent)
    with pytest.raises(InputError, match=r"other is not a part .* differ in systems, seeds"):
        merge([parts[0], tmp_path / "other"], tmp_path / "joined")
    replace(plan, restart=None).write(tmp_path / "other")
    with pytest.raises(InputError, match=r"differ in options;"):
        merge([parts[0], tmp_path / "other"], tmp_path / "joined")
    text = (parts[1] / "evaluation.json").read_text()
    digest = json.loads(text)["recordings"][0]["digest"]
    (parts[1] / "evaluation.json").write_text(text.replace(digest, "0" * 64))
    with pytest.raises(InputError, match="differ in recordings"):
        merge(parts, tmp_path / "joined")
    assert not (tmp_path / "joined").exists()


def test_what_is_no_evaluation_is_one_sentence(tmp_path, capsys):
    (tmp_path / "part").mkdir()
    assert main(["merge", str(tmp_path / "part"), "-o", str(tmp_path / "out")]) == 1
    assert "evaluation.json" in capsys.readouterr().err


def test_a_user_runs_two_parts_and_joins_them(tmp_path, capsys):
    recordings = write_recordings(tmp_path / "recordings")
    words = ["evaluate", *map(str, recordings), "--variants", "ms", "--seeds", "1"]
    for number in (1, 2):
        part = ["--part", f"{number}/2", "--workers", "1", "-o", str(tmp_path / f"p{number}")]
        assert main([*words, *part]) == 0
    assert "part 2 of 2 is in" in capsys.readouterr().out
    folders = [str(tmp_path / "p1"), str(tmp_path / "p2")]
    for out in ("all", "p1"):
        assert main(["merge", *folders, "-o", str(tmp_path / out)]) == 0
        assert "2 runs of 2 parts" in capsys.readouterr().out
        assert (tmp_path / out / "report.html").is_file()
    assert main([*words, "--part", "3/2", "-o", str(tmp_path / "p3")]) == 2
