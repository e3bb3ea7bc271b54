"""The folder with the results of one run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.evaluation.estimates import EstimateRow, write_estimates
from vehicle_pf_tracker.evaluation.metrics import Metrics
from vehicle_pf_tracker.evaluation.output_files import make_folder, output_errors, write_json

ESTIMATES, METRICS, RUN = "estimates.csv", "metrics.json", "run.json"


class ResultFolder:
    """Takes the results of one run; those of an earlier run are never left beside them.

    Parameters
    ----------
    path : Path
        Made where it is missing.

    Raises
    ------
    InputError
        If nothing can be written there; also from every method.
    """

    def __init__(self, path: Path) -> None:
        self.path = make_folder(path)

    def write_run(
        self,
        rows: Sequence[EstimateRow],
        description: Mapping[str, Any],
        extra: Mapping[str, Sequence[float | None]] = MappingProxyType({}),
    ) -> None:
        """Write `estimates.csv` with the columns `extra`, and the description to `run.json`."""
        for name in (ESTIMATES, METRICS, RUN):
            with output_errors(self.path / name):
                (self.path / name).unlink(missing_ok=True)
        write_estimates(self.path / ESTIMATES, rows, extra)
        write_json(self.path / RUN, description)

    def write_metrics(self, metrics: Metrics) -> None:
        """Write `metrics.json`."""
        write_json(self.path / METRICS, metrics.to_json())
