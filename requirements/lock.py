"""Write the lock files anew: `python requirements/lock.py python3.10 python3.11 python3.12 ...`.

`--only peers` before the interpreters writes that lock alone.

For every interpreter and every lock file, pip resolves the extras of setup.py in a throw-away
environment. A version that all interpreters share is written once; where they differ, each line
carries a marker. Give all supported interpreters, and run it on Linux x86_64.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

SETUPTOOLS = "setuptools>=77,<80"  # builds this package; the upper limit is colcon's
BASE = (SETUPTOOLS, f"{ROOT}[dev]")
ROS = (*BASE, f"{ROOT}[ros]")
COLCON = (
    *BASE,
    "colcon-bash",
    "colcon-output",
    "colcon-package-information",
    "colcon-package-selection",
    "colcon-parallel-executor",
    "colcon-ros",
    "colcon-test-result",
)
NOBLE = (  # what Ubuntu 24.04 has from apt; its Python is 3.12
    SETUPTOOLS,
    f"{ROOT}[test]",
    "numpy==1.26.4",
    "opencv-python-headless==4.6.0.66",
    "PyYAML==6.0.1",
    "rich==13.7.1",
    "pytest==7.4.4",
)
PEERS = ("opencv-contrib-python-headless<5",)  # the trackers compared with
# The ROS wheels unpack metadata of their own besides; only what pip installed has a WHEEL file.
INSTALLED = """
from importlib.metadata import distributions
for found in distributions():
    if found.read_text("WHEEL"):
        print(f"{found.name}=={found.version}")
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=["peers"])
    parser.add_argument("interpreters", nargs="+")
    args = parser.parse_args()
    locks: dict[str, dict[str, set[str]]] = {}
    for interpreter in args.interpreters:
        version = run(interpreter, "-c", "import sys; print('%d.%d' % sys.version_info[:2])")[0]
        pins = {"peers": resolve(interpreter, PEERS)}
        if args.only is None:
            pins |= own_pins(interpreter, version)
        for lock, found in pins.items():
            locks.setdefault(lock, {})[version] = found
    for lock, by_version in locks.items():
        (HERE / f"{lock}.txt").write_text(merged(by_version))


def own_pins(interpreter: str, version: str) -> dict[str, set[str]]:
    """Return the pins of every lock that this package itself is installed with."""
    base = resolve(interpreter, BASE)
    pins = {
        "locked": base,
        "ros-jazzy": resolve(interpreter, ROS) - base,
        "colcon": resolve(interpreter, COLCON) - base,
    }
    if version in {"3.10", "3.11", "3.12"}:  # NumPy 1.26 has no wheels for later ones
        pins["noble"] = resolve(interpreter, NOBLE)
    return pins


def resolve(interpreter: str, wanted: tuple[str, ...]) -> set[str]:
    """Return what pip installs for these requirements, as exact pins."""
    with tempfile.TemporaryDirectory() as folder:
        run(interpreter, "-m", "venv", folder)
        python = str(Path(folder, "bin", "python"))
        run(python, "-m", "pip", "uninstall", "--quiet", "--yes", "setuptools")
        run(python, "-m", "pip", "install", "--quiet", "--upgrade", "pip")
        run(python, "-m", "pip", "install", "--quiet", *wanted)
        pins = run(python, "-c", INSTALLED)
    return {pin for pin in pins if pin.split("==")[0] not in {"pip", "vehicle_pf_tracker"}}


def merged(by_version: dict[str, set[str]]) -> str:
    """One requirements file for all interpreters."""
    lines = [f"# Written by requirements/lock.py for Python {', '.join(by_version)}."]
    pins = set[str]().union(*by_version.values())
    for pin in sorted(pins, key=str.lower):
        versions = [version for version in by_version if pin in by_version[version]]
        marker = " or ".join(f"python_version == '{version}'" for version in versions)
        lines.append(pin if len(versions) == len(by_version) else f"{pin}; {marker}")
    return "\n".join(lines) + "\n"


def run(*command: str) -> list[str]:
    print("+", *command, file=sys.stderr)
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, cwd=HERE)
    return done.stdout.splitlines()


if __name__ == "__main__":
    main()
