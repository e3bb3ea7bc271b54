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

"""Location of the default parameter files, however the package was installed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

_NAME = "vehicle_pf_tracker"
_SHARE = Path("share", _NAME, "config")
ROOT = Path(__file__).resolve().parents[2]


def config_path(variant: str) -> Path:
    """Find the default parameter file of a variant.

    Parameters
    ----------
    variant
        Name of a registered variant; its file is ``<variant>.yaml``.

    Returns
    -------
    Path
        An existing file. The copy that belongs to the running code comes before those of other
        installs.

    Raises
    ------
    InputError
        If no install of the package holds the file.
    """
    folders = [folder for folder in _folders() if folder.is_dir()]
    for folder in folders:
        path = folder / f"{variant}.yaml"
        if path.is_file():
            return path
    if not folders:
        raise InputError(
            f"the default parameter files ({_SHARE}) are not installed: install the package anew, "
            f"or write this one with `vehicle-pf-tracker params {variant}`"
        )
    known = ", ".join(sorted(path.stem for path in folders[0].glob("*.yaml"))) or "none"
    raise InputError(f"no parameter file for variant {variant!r} in {folders[0]}: it has {known}")


def _folders() -> Iterator[Path]:
    """Yield the folders to look in, best first: nothing is assumed to exist."""
    if (ROOT / "package.xml").is_file():  # a checkout: editable and symlink installs run from it
        yield ROOT / "config"
    yield from _recorded_folders()
    yield ROOT / _SHARE  # pip --target: shares sit beside the packages, the record is not adapted
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(prefix) / _SHARE


def _recorded_folders() -> Iterator[Path]:
    """Yield the folders which pip's record of installed files names for this very package."""
    try:
        files = metadata.distribution(_NAME).files or []
    except metadata.PackageNotFoundError:
        return
    located = [Path(os.path.normpath(file.locate())) for file in files]
    if Path(__file__) in located:
        yield from dict.fromkeys(
            path.parent for path in located if path.parent.match(str(Path("*") / _SHARE))
        )
