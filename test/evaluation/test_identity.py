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

from pathlib import Path

import pytest

import vehicle_pf_tracker
from vehicle_pf_tracker.evaluation import result_store
from vehicle_pf_tracker.evaluation.result_store import source_digest

FILES = {
    "start.py": "from made.middle import thing\nimport numpy\n",
    "middle.py": "def f():\n    import made.sub.late\n",
    "sub/__init__.py": "",
    "sub/late.py": "X = 1\n",
    "other.py": "Y = 1\n",
    "table.py": "from made import other\n",
}


@pytest.fixture
def root(tmp_path):
    (tmp_path / "made" / "sub").mkdir(parents=True)
    for name, text in FILES.items():
        (tmp_path / "made" / name).write_text(text)
    return tmp_path


def digest(root, *modules):
    result_store.imported_modules.cache_clear()
    source_digest.cache_clear()
    return source_digest(frozenset(modules), root, "made")


@pytest.mark.parametrize("name", ["start.py", "middle.py", "sub/late.py"])
def test_whatever_is_imported_counts_also_late(root, name):
    before = digest(root, "made.start")
    file = root / "made" / name
    file.write_text(FILES[name] + "# changed")
    assert digest(root, "made.start") != before
    file.write_text(FILES[name])
    assert digest(root, "made.start") == before


def test_a_start_in_another_package_counts_with_what_it_imports_from_both(root):
    (root / "guest").mkdir()
    (root / "guest" / "cells.py").write_text("from guest import scenes\nimport made.start\n")
    (root / "guest" / "scenes.py").write_text("S = 1\n")
    before = digest(root, "guest.cells")
    for folder, name in (("guest", "scenes.py"), ("made", "middle.py")):
        file = root / folder / name
        kept = file.read_text()
        file.write_text(kept + "# changed")
        assert digest(root, "guest.cells") != before
        file.write_text(kept)


@pytest.mark.parametrize("name", ["plugged", "plugged.cells"])
def test_a_plug_in_counts_where_it_is_installed(root, tmp_path_factory, monkeypatch, name):
    site = tmp_path_factory.mktemp("site")
    file = site.joinpath(*name.split(".")).with_suffix(".py")
    file.parent.mkdir(exist_ok=True)
    monkeypatch.syspath_prepend(site)
    result_store._home.cache_clear()
    digests = []
    for text in ("import made.start\n", "import made.start\nX = 1\n", "import made.other\n"):
        file.write_text(text)
        digests.append(digest(root, name))
    assert len(set(digests)) == 3


def test_what_is_not_imported_does_not_count(root):
    before = digest(root, "made.start")
    (root / "made" / "other.py").write_text("Y = 2\n")
    assert digest(root, "made.start") == before
    assert digest(root, "made.start", "made.other") != before


def test_a_table_and_what_it_lists_do_not_count(root, monkeypatch):
    monkeypatch.setattr(result_store, "_TABLES", frozenset({"made.table"}))
    (root / "made" / "sub" / "late.py").write_text("import made.table\n")
    before = digest(root, "made.start")
    for name in ("other.py", "table.py"):
        (root / "made" / name).write_text("Y = 2\n")
        assert digest(root, "made.start") == before


def test_one_variant_does_not_decide_another():
    names = [
        f"vehicle_pf_tracker.trackers.{name}" for name in ("papers.apf", "papers.ms", "session")
    ]
    assert len({source_digest(frozenset({name})) for name in names}) == 3
    ours = frozenset({"vehicle_pf_tracker"})
    root = Path(vehicle_pf_tracker.__file__).parents[1]
    found = result_store.imported_modules("vehicle_pf_tracker.trackers.session", root, ours)
    assert "vehicle_pf_tracker.trackers.registry" in found


def test_a_start_that_is_not_there_is_an_error(root):
    with pytest.raises(ModuleNotFoundError, match=r"made\.gone"):
        digest(root, "made.gone")
