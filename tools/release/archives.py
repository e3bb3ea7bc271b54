# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The wheel and the source archive of a version, as `make dist` leaves them in a folder."""

from __future__ import annotations

import re
import tarfile
import zipfile
from pathlib import Path
from typing import NamedTuple

from tools.release.commands import ReleaseError

_NAME = "vehicle_pf_tracker"


class Archives(NamedTuple):
    """Paths of both archives."""

    wheel: Path
    source: Path

    @classmethod
    def of(cls, folder: Path, version: str) -> Archives:
        """Name the archives of a version, whether or not they are there."""
        stem = f"{_NAME}-{version}"
        return cls(folder / f"{stem}-py3-none-any.whl", folder / f"{stem}.tar.gz")


def check_archives(archives: Archives) -> str:
    """Check that both archives are there, with the licence in them; return their names."""
    for path in archives:
        if not path.exists():
            raise ReleaseError(f"{path} is not there: `make dist`")
    with zipfile.ZipFile(archives.wheel) as wheel, tarfile.open(archives.source) as source:
        names = {archives.wheel: wheel.namelist(), archives.source: source.getnames()}
    for path, inside in names.items():
        if not any(re.search(r"(^|/)LICENSE$", name) for name in inside):
            raise ReleaseError(f"{path.name} has no LICENSE")
    return ", ".join(path.name for path in archives)
