"""A cell of the grid: one system on one recording with one seed, from one start."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from vehicle_pf_tracker.evaluation.evaluation_folder import cell_folder, safe_name
from vehicle_pf_tracker.evaluation.grid.starts import USUAL, Start
from vehicle_pf_tracker.evaluation.grid.systems import System, VariantSystem
from vehicle_pf_tracker.evaluation.identity import result_key, variant_modules
from vehicle_pf_tracker.evaluation.source import Source
from vehicle_pf_tracker.trackers.registry import find_variant

BESIDE = "robustness"
"""Folder of what is run beside the grid."""

_PACKAGE = "vehicle_pf_tracker"
_SHARED = frozenset({f"{_PACKAGE}.recordings.reader"})
_OURS = frozenset({f"{_PACKAGE}.evaluation.offline"})
_PEERS = frozenset(
    f"{_PACKAGE}.evaluation.baselines.{name}" for name in ("rows", "client", "worker")
)
_STARTS = frozenset({f"{_PACKAGE}.evaluation.grid.starts", f"{_PACKAGE}.evaluation.grid.restarts"})


@dataclass(frozen=True, slots=True)
class GridCell:
    """Says everything that its run depends on.

    Attributes
    ----------
    source : Source
        The recording.
    system : VariantSystem or PeerSystem
        What follows the vehicle.
    seed : int
        Of the random numbers.
    start : Start
        Where it starts.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    """

    source: Source
    system: System
    seed: int
    max_diff: float
    start: Start = USUAL

    @property
    def label(self) -> str:
        """What to call it while it runs."""
        words = (self.source.name, self.system.label, str(self.seed), self.start.kind)
        return " ".join(word for word in (*words, self.start.name) if word)

    def key(self) -> str:
        """Digest all that decides its run: recording, parameters, seed, start, code, versions."""
        facts = {
            "recording": self.source.digest,
            "topic": self.source.topic,
            "max_diff": self.max_diff,
            "start": asdict(self.start),
            **self.system.facts(self.seed),
        }
        return result_key(facts, self._modules())

    def folder(self, evaluation: Path) -> Path:
        """Return its folder in the folder of the evaluation."""
        names = self.source.name, self.system.label, self.seed
        if not self.start.kind:
            return cell_folder(evaluation, *names)
        below = cell_folder(evaluation / BESIDE / self.start.kind, *names, cells="")
        return below / safe_name(self.start.name) if self.start.name else below

    def _modules(self) -> frozenset[str]:
        modules = _SHARED | (_STARTS if self.start.kind else frozenset())
        if isinstance(self.system, VariantSystem):
            return modules | _OURS | variant_modules(find_variant(self.system.variant))
        return modules | _PEERS
