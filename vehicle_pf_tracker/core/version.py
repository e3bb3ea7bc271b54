# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Version of the installed package."""

from __future__ import annotations

_PACKAGE = __name__.partition(".")[0]


def installed_version() -> str:
    """Return the version that package.xml states and the installation has recorded."""
    from importlib import metadata  # noqa: PLC0415 - 20 ms that only the version costs

    try:
        return metadata.version(_PACKAGE)
    except metadata.PackageNotFoundError:
        return "0+unknown"  # run from a folder of sources that nobody installed
