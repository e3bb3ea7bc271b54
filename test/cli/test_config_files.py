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

"""Finding the default parameter files; real installs are tried in test/packaging."""

from pathlib import Path

import pytest

from vehicle_pf_tracker.cli import config_files
from vehicle_pf_tracker.cli.config_files import config_path
from vehicle_pf_tracker.core.errors import InputError

SHARE = Path("share", "vehicle_pf_tracker", "config")


@pytest.fixture
def nowhere(monkeypatch, tmp_path):
    """Code without any install around it, in tmp_path/code."""
    code = tmp_path / "code" / "vehicle_pf_tracker" / "cli" / "config_files.py"
    monkeypatch.setattr(config_files, "__file__", str(code))
    monkeypatch.setattr(config_files, "ROOT", tmp_path / "code")
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    return tmp_path


def place(folder: Path, name: str = "apf") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.yaml"
    path.write_text("")
    return path


def test_a_checkout_uses_its_own_files(nowhere, monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(nowhere / "ws"))
    place(nowhere / "ws" / SHARE)
    own = place(nowhere / "code" / "config")
    (nowhere / "code" / "package.xml").write_text("")
    assert config_path("apf") == own


def test_a_folder_called_config_beside_an_installed_package_is_not_taken(nowhere):
    place(nowhere / "code" / "config")
    with pytest.raises(InputError):
        config_path("apf")


def test_the_first_ros_workspace_that_has_the_file_wins(nowhere, monkeypatch):
    prefixes = [nowhere / "empty", nowhere / "overlay", nowhere / "underlay"]
    monkeypatch.setenv("AMENT_PREFIX_PATH", ":".join(["", *map(str, prefixes)]))
    expected = place(prefixes[1] / SHARE)
    place(prefixes[2] / SHARE)
    only_below = place(prefixes[2] / SHARE, "pf")
    assert config_path("apf") == expected
    assert config_path("pf") == only_below


def test_an_unknown_variant_is_told_what_there_is(nowhere):
    place(nowhere / "code" / SHARE, "pf")
    place(nowhere / "code" / SHARE, "apf")
    with pytest.raises(InputError, match=r"'afp'.*it has apf, pf$"):
        config_path("afp")


def test_missing_files_are_told_with_the_remedy(nowhere):
    with pytest.raises(InputError, match=r"not installed.*vehicle-pf-tracker params apf"):
        config_path("apf")
