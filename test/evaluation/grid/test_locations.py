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

import pytest
from grid_samples import here, make_plan, results, silent, system, write_recordings

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.running import complete
from vehicle_pf_tracker.evaluation.grid.sources import find_recordings, local_copy

fsspec = pytest.importorskip("fsspec")


@pytest.fixture
def far(tmp_path):
    """Two recordings in a file system that is none of this machine's."""
    memory = fsspec.filesystem("memory")
    for path in write_recordings(tmp_path / "near"):
        memory.put(f"{path}/", f"/far/{path.name}/", recursive=True)
    yield "memory://far"
    memory.rm("/far", recursive=True)


def test_urls_of_recordings_and_of_folders_are_found(far):
    both = [f"memory:///far/{name}" for name in ("bridge", "free")]
    assert find_recordings([far]) == both
    assert find_recordings([f"{far}/free", far]) == [both[1], both[0]]
    (file,) = find_recordings([f"{far}/free/free_0.mcap"])
    assert local_copy(file).name == "free_0.mcap"


def test_what_comes_from_far_away_gives_the_same_results(far, tmp_path):
    systems = [system("ms")]
    complete(make_plan(find_recordings([far]), systems), tmp_path / "far", here, silent)
    near = find_recordings([str(tmp_path / "near")])
    complete(make_plan(near, systems), tmp_path / "here", here, silent)
    cells = [
        {name: result for name, result in results(tmp_path / place).items() if "estimates" in name}
        for place in ("far", "here")
    ]
    assert len(cells[0]) == 2
    assert cells[0] == cells[1]


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("memory://far/none", "there is no recording memory://far/none"),
        ("nonsense://far", "cannot read the recording nonsense://far: .*nonsense"),
        ("file:///dev/null/far", "file:///dev/null/far"),
    ],
)
def test_urls_that_name_nothing_are_told(far, url, said):
    with pytest.raises(InputError, match=said):
        find_recordings([url])


def test_a_folder_far_away_without_recordings_is_told():
    memory = fsspec.filesystem("memory")
    memory.makedirs("/bare/inner")
    with pytest.raises(InputError, match="memory://bare is not a recording and holds none"):
        find_recordings(["memory://bare"])
    memory.rm("/bare", recursive=True)
