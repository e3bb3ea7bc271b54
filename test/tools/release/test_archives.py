# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The check of the archives, on archives that are made for it."""

import tarfile
import zipfile

import pytest

from tools.release.archives import Archives, check_archives
from tools.release.commands import ReleaseError


def write(archives, *, of_wheel, of_source):
    with tarfile.open(archives.source, "w:gz") as made:
        for name in of_source:
            made.addfile(tarfile.TarInfo(name))
    with zipfile.ZipFile(archives.wheel, "w") as made:
        for name in of_wheel:
            made.writestr(name, "")


def test_archives_have_the_licence(tmp_path):
    archives = Archives.of(tmp_path, "1.2.3")
    with pytest.raises(ReleaseError, match=r"whl is not there: `make dist`"):
        check_archives(archives)
    code = "vehicle_pf_tracker/__init__.py"
    in_wheel, in_source = "vehicle_pf_tracker-1.2.3.dist-info/LICENSE", "vehicle_pf_tracker/LICENSE"
    write(archives, of_wheel=[code], of_source=[in_source])
    with pytest.raises(ReleaseError, match=r"any\.whl has no LICENSE"):
        check_archives(archives)
    write(archives, of_wheel=[in_wheel], of_source=[code])
    with pytest.raises(ReleaseError, match=r"1\.2\.3\.tar\.gz has no LICENSE"):
        check_archives(archives)
    write(archives, of_wheel=[in_wheel], of_source=[in_source])
    names = "vehicle_pf_tracker-1.2.3-py3-none-any.whl, vehicle_pf_tracker-1.2.3.tar.gz"
    assert check_archives(archives) == names
