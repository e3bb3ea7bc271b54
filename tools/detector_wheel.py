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

from vehicle_pf_tracker.following.networks.known_networks import (
    DETECTOR_PACKAGE,
    KNOWN_NETWORKS,
    KnownNetwork,
)

ROOT = Path(__file__).parents[1]
VERSION = "0.1.1"
"""Version of the makers' release, which they call 0.1.1rc0: pip takes no candidates unasked."""
# Files of the wheel.
_PROJECT = """\
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


def build(network: Path, out: Path) -> tuple[Path, str]:
    """Build the wheel, and return its path and what is known of the file.

    Parameters
    ----------
    network : Path
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
    known = {network.file: name for name, network in KNOWN_NETWORKS.items()}
    if network.name not in known:
        raise ValueError(f"{network.name} is none of {', '.join(known)}")
    name = known[network.name]
    digest = hashlib.sha256(network.read_bytes()).hexdigest()
    verdict = _verdict(KNOWN_NETWORKS[name], digest)
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder)
        package = project / DETECTOR_PACKAGE
        package.mkdir()
        shutil.copy(network, package)
        shutil.copy(ROOT / "LICENSE", project)  # Apache-2.0 as well
        (package / "__init__.py").write_text(f'"""The file {network.name}."""\n', encoding="utf-8")
        facts = {
            "licence": KNOWN_NETWORKS[name].licence,
            "package": DETECTOR_PACKAGE,
            "version": VERSION,
        }
        text = _PROJECT.format(name=DETECTOR_PACKAGE.replace("_", "-"), network=name, **facts)
        (project / "pyproject.toml").write_text(text, encoding="utf-8")
        notice = _NOTICE.format(
            file=network.name,
            url=KNOWN_NETWORKS[name].url,
            licence=KNOWN_NETWORKS[name].licence,
            digest=digest,
            verdict=verdict,
        )
        (project / "NOTICE").write_text(notice, encoding="utf-8")
        out.mkdir(parents=True, exist_ok=True)
        words = ["--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", str(out.absolute())]
        subprocess.run([sys.executable, "-m", "pip", "wheel", *words, str(project)], check=True)
    return out / f"{DETECTOR_PACKAGE}-{VERSION}-py3-none-any.whl", verdict


def _verdict(network: KnownNetwork, digest: str) -> str:
    if digest == network.sha256:
        return "It is the sum that others state of the makers' file; the makers state none."
    return f"It is not the sum that others state of the makers' file, {network.sha256}."


def main() -> int:
    """Build the wheel of the file on the command line."""
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
