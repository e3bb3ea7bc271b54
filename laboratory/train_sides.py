# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Train the network that finds where a vehicle ends for `fusion` (`side_network.py`).

    python -m laboratory.train_sides SEQUENCES... -o side_network.npz [--parts FOLDER]

`side_examples` draws boxes around the true ones, and `side_training` trains on them. All sequences
of one folder are taken to be of one camera.

The cameras are dealt into four parts. For each part the errors of a network that was trained on the
other three are measured. Their deviation is stored as the noise of the network that is written,
which is trained on all cameras. `--parts` keeps the four, and which cameras each has not seen:
`python -m laboratory stress --side-network` judges `fusion` with them. The same sequences give the
same files.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from laboratory.side_examples import Examples, by_output, collected
from laboratory.side_training import OUTPUTS, trained
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.image.patches.side_network import SideNetwork
from vehicle_pf_tracker.results.output_files import make_folder

PROGRAM = "python -m laboratory.train_sides"
PARTS = 4
"""Parts that cameras are dealt into."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog=PROGRAM, description="Train the network for the sides.")
    parser.add_argument("sequences", nargs="+", type=Path, help="sequences with truth, or folders")
    parser.add_argument("-o", "--output", type=Path, required=True, help="file of the network")
    parser.add_argument(
        "--parts", type=Path, metavar="FOLDER", help="where to keep the networks of the four parts"
    )
    args = parser.parse_args(argv)
    return exit_status(lambda: _run(args.sequences, args.output, args.parts), PROGRAM)


def _run(locations: Sequence[Path], output: Path, kept: Path | None) -> int:
    examples = collected(locations)
    part = parts_of(examples.camera)
    networks = [trained(examples.taken(part != number)) for number in range(PARTS)]
    errors = left_out_errors(examples, part, networks)
    bias, noise = deviations(errors, examples.vehicle)
    make_folder(output.parent)
    trained(examples)._replace(noise=noise).write(output)
    if kept is not None:
        make_folder(kept)
        for number, network in enumerate(networks):
            network._replace(noise=noise).write(kept / f"{number}.npz")
        pairs = sorted({*zip(part.tolist(), examples.camera.tolist(), strict=True)})
        lines = [f"{number},{examples.names[camera]}\n" for number, camera in pairs]
        table = "".join(["part,camera\n", *lines])
        (kept / "cameras.csv").write_text(table, encoding="utf-8")
    spread = by_output(examples.beyond).std(axis=0)
    rows = [
        [name, *(f"{value:.3f}" for value in values)]
        for name, *values in zip(OUTPUTS, spread, bias, noise, strict=True)
    ]
    cameras = len(np.unique(examples.camera))
    print(f"{len(examples.camera)} boxes of {cameras} cameras, which are left out in turns.\n")
    print(markdown(["side", "off by", "error's mean by vehicle", "around it"], rows))
    return 0


def left_out_errors(
    examples: Examples, part: npt.NDArray[np.intp], networks: Sequence[SideNetwork]
) -> npt.NDArray[np.float32]:
    """Errors (N, 4) of networks that the camera of each box had no part in.

    `part` (N,) is the number of the one of `networks` that has not seen it.
    """
    errors = np.zeros_like(examples.beyond)
    for index, number in enumerate(part):
        answers = networks[number].beyond(examples.cells[index].astype(np.float32)).ravel()
        errors[index] = examples.beyond[index] - answers
    return errors


def parts_of(camera: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Deal cameras into parts, (N,): those with most boxes first, to the part that has fewest."""
    counts = np.bincount(camera)
    parts = np.zeros(len(counts), np.intp)
    total = np.zeros(PARTS)
    for number in np.argsort(-counts, kind="stable"):
        parts[number] = total.argmin()
        total[parts[number]] += counts[number]
    return parts[camera]


def deviations(
    errors: npt.NDArray[np.float32], vehicle: npt.NDArray[np.intp]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Compute the standard deviations of a vehicle's mean error, and of errors around it.

    Each (3,): those of the left and the right side are one.
    """
    groups = [errors[vehicle == number] for number in np.unique(vehicle)]
    means = np.array([(group.mean(axis=0) ** 2) for group in groups]).mean(axis=0)
    around = np.array([group.var(axis=0) for group in groups]).mean(axis=0)
    return _three(means), _three(around)


def _three(variances: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    left, top, right, bottom = variances
    return np.sqrt(np.array([(left + right) / 2, top, bottom], np.float32))


if __name__ == "__main__":
    sys.exit(main())
