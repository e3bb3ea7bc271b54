# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The wheel `vehicle-pf-detector`: a network of others as a package, built from a file you have.

    python -m tools.detector_wheel yolox_nano.onnx -o results/dist

An organisation installs it from an index of its own; `--model yolox-nano` then takes its file.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from tools import ROOT
from vehicle_pf_tracker.following.networks.known_networks import (
    DETECTOR_PACKAGE,
    KNOWN_NETWORKS,
    KnownNetwork,
)

VERSION = "0.1.1"
"""Version of the makers' release, which they call 0.1.1rc0: pip takes no candidates unasked."""
_PYPROJECT = """\
[build-system]
requires = ["setuptools>=64"]
build-backend = "setuptools.build_meta"

[project]
name = "{name}"
version = "{version}"
description = "{network} of its makers, for `vehicle-pf-tracker traffic --model {network}`"
license = {{text = "{licence}"}}
requires-python = ">=3.10"

[tool.setuptools]
packages = ["{package}"]
license-files = ["LICENSE", "NOTICE"]

[tool.setuptools.package-data]
{package} = ["*.onnx"]
"""
_NOTICE = """\
{file} is a network of the YOLOX authors (Megvii), not of those who packed it.
Address of its makers: {url}
Licence of their repository: {licence}. The weights have no licence of their own.
SHA-256 of the file in this package: {digest}
{verdict}
"""


class Built(NamedTuple):
    """Wheel that was built.

    Attributes
    ----------
    wheel : Path
        Its file.
    verdict : str
        Sentence on whether the network in it is known to be that of its makers.
    """

    wheel: Path
    verdict: str


def build(file: Path, out: Path) -> Built:
    """Build the wheel of a network's file.

    Parameters
    ----------
    file : Path
        The file, under its makers' name.
    out : Path
        Folder for the wheel.

    Raises
    ------
    ValueError
        If the name is none of a known network.
    subprocess.CalledProcessError
        If pip cannot build it.
    """
    name, network = _known(file)
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    verdict = _verdict(network, digest)
    notice = _NOTICE.format(
        file=file.name, url=network.url, licence=network.licence, digest=digest, verdict=verdict
    )
    with tempfile.TemporaryDirectory() as folder:
        _write_project(Path(folder), name, file, notice)
        _build_wheel(Path(folder), out)
    return Built(out / f"{DETECTOR_PACKAGE}-{VERSION}-py3-none-any.whl", verdict)


def _known(file: Path) -> tuple[str, KnownNetwork]:
    """Return the name by which `--model` knows a file, and what is known of it."""
    for name, network in KNOWN_NETWORKS.items():
        if network.file == file.name:
            return name, network
    names = ", ".join(network.file for network in KNOWN_NETWORKS.values())
    raise ValueError(f"{file.name} is none of {names}")


def _verdict(network: KnownNetwork, digest: str) -> str:
    if digest == network.sha256:
        return "It is the sum that others state of the makers' file; the makers state none."
    return f"It is not the sum that others state of the makers' file, {network.sha256}."


def _write_project(folder: Path, name: str, file: Path, notice: str) -> None:
    """Write a project of Python whose only package has the file in it."""
    package = folder / DETECTOR_PACKAGE
    package.mkdir()
    shutil.copy(file, package)
    pyproject = _PYPROJECT.format(
        name=DETECTOR_PACKAGE.replace("_", "-"),
        version=VERSION,
        network=name,
        licence=KNOWN_NETWORKS[name].licence,
        package=DETECTOR_PACKAGE,
    )
    texts = {
        package / "__init__.py": f'"""The file {file.name}."""\n',
        folder / "pyproject.toml": pyproject,
        folder / "NOTICE": notice,
        folder / "LICENSE": (ROOT / "LICENSE").read_text(encoding="utf-8"),  # Apache-2.0 as well
    }
    for path, text in texts.items():
        path.write_text(text, encoding="utf-8")


def _build_wheel(project: Path, out: Path) -> None:
    """Build the wheel of a project with what is installed: no index is asked for a builder."""
    out.mkdir(parents=True, exist_ok=True)
    words = ["--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", str(out.absolute())]
    subprocess.run([sys.executable, "-m", "pip", "wheel", *words, str(project)], check=True)


def main() -> int:
    """Build the wheel of the file on the command line, and return the status."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("network", type=Path, help="the file, as yolox_nano.onnx")
    parser.add_argument("-o", "--output", type=Path, default=Path("results/dist"))
    args = parser.parse_args()
    try:
        wheel, verdict = build(args.network, args.output)
    except (ValueError, OSError) as error:
        print(f"detector_wheel: {error}", file=sys.stderr)
        return 1
    print(f"{wheel}\n{verdict}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
