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

"""Run the grid on a Dask cluster whose workers have this package and can read the recordings."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Iterator, Mapping, Sequence
from concurrent import futures
from functools import partial
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.cells import GridCell
from vehicle_pf_tracker.evaluation.grid.running import Runner
from vehicle_pf_tracker.evaluation.grid.tracking import CellResult, run_cell
from vehicle_pf_tracker.evaluation.processes import Turn


def on_cluster(address: str, seconds: float = 10.0) -> Runner:
    """Return what runs cells on the cluster of a scheduler.

    A cell whose worker dies is run again on another one. Each result is given once.

    Parameters
    ----------
    address : str
        Address of the scheduler, as ``tcp://host:8786``.
    seconds : float
        Time to wait for the scheduler, s.

    Raises
    ------
    InputError
        From the runner, if the scheduler cannot be reached, has no worker, or is lost on the way.
    """
    return partial(_run, address, seconds)


def run_checked(cell: GridCell, key: str) -> CellResult:
    """Run a cell on a worker whose code and libraries are those that it was planned with."""
    if cell.key() == key:
        return run_cell(cell)
    return CellResult(
        reason=f"the worker on {socket.gethostname()} has other code or other versions of Python, "
        "NumPy, OpenCV or numba than the machine that evaluates; install the same everywhere"
    )


def _run(
    address: str, seconds: float, cells: Sequence[GridCell]
) -> Iterator[Turn[GridCell, CellResult]]:
    if not cells:
        return
    client = _connected(address, seconds)
    try:
        yield from _results(client, cells)
    except (OSError, futures.CancelledError, asyncio.CancelledError) as error:
        raise InputError(
            f"the Dask scheduler at {address} was lost on the way; start it and its workers again, "
            "and run the same command: the results so far are kept"
        ) from error
    finally:
        client.close()


def _connected(address: str, seconds: float) -> Any:
    try:
        from distributed import Client  # noqa: PLC0415 - an extra
    except ModuleNotFoundError:
        raise InputError(
            "a Dask cluster needs the extra [cluster]: `pip install 'vehicle_pf_tracker[cluster]'`"
        ) from None
    # Its log would print a traceback beside our sentence when the scheduler is lost.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = Client(address, timeout=seconds, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # a TimeoutError is an OSError
        raise InputError(f"cannot reach a Dask scheduler at {address}") from error
    if not client.scheduler_info(n_workers=-1)["workers"]:
        client.close()
        raise InputError(f"the Dask scheduler at {address} has no workers; start `dask worker`")
    return client


def _results(client: Any, cells: Sequence[GridCell]) -> Iterator[Turn[GridCell, CellResult]]:
    from distributed import as_completed  # noqa: PLC0415 - an extra

    by_key = {f"{cell.label}-{cell.key()}".replace(" ", "-"): cell for cell in cells}
    submitted = [client.submit(run_checked, cell, cell.key(), key=k) for k, cell in by_key.items()]
    yield Turn(None, _running(client, by_key))
    waiting = as_completed(submitted, loop=client.loop)
    submitted.clear()  # so that each result can go once it is here
    for future in waiting:
        yield Turn((by_key[future.key], _outcome(future)), _running(client, by_key))


def _outcome(future: Any) -> CellResult:
    error = future.exception()
    if error is None:
        outcome: CellResult = future.result()
        return outcome
    return CellResult(reason=f"the cluster gave it up: {' '.join(str(error).split())}")


def _running(client: Any, by_key: Mapping[str, GridCell]) -> tuple[GridCell, ...]:
    """Return the cells at work; a worker is given more than it has threads for."""
    threads = client.nthreads()
    keys = [
        key
        for worker, given in client.processing().items()
        for key in list(given)[: threads.get(worker, 0)]
    ]
    return tuple(by_key[key] for key in keys if key in by_key)
