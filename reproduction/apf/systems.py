# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The first paper's artificial video, its six trackers, and the interpretations of its own."""

from __future__ import annotations

from dataclasses import dataclass

from reproduction.experiment import OUR_INTERPRETATION, PAPER_RULE, PRINTED_RULE
from reproduction.runs.cells import RunCell, SceneChoice, System
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.parameters.table import Value

VEHICLE_WIDTH, VEHICLE_HEIGHT = 30.0, 22.0
"""Size of the vehicle, px: the bar of 30 px in the paper's figure 2 hides it wholly."""
VEHICLE_SPEED = 5.0
"""Speed of the vehicle where the paper keeps it constant, px/frame."""
BAR_SETTING = (
    f"The artificial video (scene `bar`): a {VEHICLE_WIDTH:g} x {VEHICLE_HEIGHT:g} px vehicle on "
    "even ground with sensor noise, 15 frames per second."
)


def artificial_video(width: float, speed: float = VEHICLE_SPEED) -> SceneChoice:
    """Choose the video with a bar of `width` px; 0 leaves it out."""
    size = {"vehicle_width": VEHICLE_WIDTH, "vehicle_height": VEHICLE_HEIGHT}
    return SceneChoice.of("bar", {"speed": float(speed), "width": float(width), **size})


def covered(truths: list[Truth]) -> tuple[int, int] | None:
    """Return the first and the last frame (from 1) in which something hides the vehicle."""
    frames = [n for n, t in enumerate(truths, start=1) if t.occlusion is not Occlusion.NONE]
    return (frames[0], frames[-1]) if frames else None


SIGMA_V = 0.1
"""One likelihood for all trackers: of 0.1 and 0.158 (Perez's lambda of 20) it gave each of the five
that have one the smaller mean RMSE, on `video01` to `video18` with seeds 100 to 104."""
_LIKELIHOOD: dict[str, Value] = {"likelihood.sigma_v": SIGMA_V}
_FIXED: dict[str, Value] = {
    "occlusion.rule": "fixed",
    "occlusion.tau": 0.8,
    "reference.alpha": 0.01,
}
APF = System.of("APF", "apf", {**_FIXED, **_LIKELIHOOD})
"""The paper's rule: its step 4 with the printed tau, and the alpha of `INTERPRETATIONS_NOTE`."""
APF_RIVALS = (
    System.of("PF", "pf", _LIKELIHOOD),
    System.of("SAPF", "sapf", _LIKELIHOOD),
    System.of("HPFMS", "hpfms", _LIKELIHOOD),
    System.of("PFCL", "pfcl", _LIKELIHOOD),
    System.of("MS", "ms"),
)
"""Rivals in the order of the paper's tables."""
RELATIVE = System.of("APF, relative", "apf", {"occlusion.rule": "relative", **_LIKELIHOOD})
"""Our interpretation: similarities are compared with their own running level."""
AS_PRINTED = System.of("APF as printed", "apf", {"as_printed": True})
"""The paper to the letter."""
INTERPRETATIONS = {PAPER_RULE: APF, OUR_INTERPRETATION: RELATIVE, PRINTED_RULE: AS_PRINTED}
"""The paper's tracker by interpretation; the first one gives the verdict."""
INTERPRETATIONS_NOTE = (
    "The paper's rule is step 4 of its algorithm with a tau of 0.8, which the paper prints for its "
    "artificial videos alone; `video01` to `video20` have the same. The paper prints no alpha; "
    "0.01 was chosen among 0.003, 0.01, 0.03 and 0.1 on `video01` to `video18`, seeds 100 to 104 "
    "(23.4, 23.7, 26.5 and 27.9 px). Our interpretation is the default of `apf`: the extension "
    "`occlusion.rule: relative` compares the similarities with their own running level. As "
    "printed follows the paper to the letter."
)
_OWN: dict[str, Value] = {"likelihood.sigma_v": 0.158}
"""Perez's lambda of 20, the default of the rivals' variants."""
OWN_LIKELIHOOD = tuple(
    System.of(f"{rival.label}, sigma_v 0.158", rival.variant, _OWN)
    for rival in APF_RIVALS
    if rival.variant != "ms"
)
"""The rivals with the likelihood that their papers have, which is their variants' default."""
LIBERTIES = (
    System.of("HPFMS, 200 windows", "hpfms", {**_LIKELIHOOD, "num_particles": 50}),
    System.of("SAPF, tied", "sapf", {**_LIKELIHOOD, "annealing.tied": True}),
    System.of("PF, second order", "pf", {**_LIKELIHOOD, "dynamics": "second_order", "sigma": 1.0}),
)
"""The rivals with options that their own papers have, or with APF's number of measurements: three
steps of mean shift and one measurement for each of 50 particles are 200 windows."""
SIX_SYSTEMS = (APF, *APF_RIVALS)
"""The six trackers of the paper's figures and tables, its own first."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """One form of APF, and the rivals that it is compared with.

    Attributes
    ----------
    name : str
        Name in the tables of findings.
    apf : System
        The paper's tracker.
    rivals : tuple of System
        The five others, in the order of the paper's tables.
    """

    name: str
    apf: System
    rivals: tuple[System, ...]

    @property
    def rival_labels(self) -> tuple[str, ...]:
        """Labels of the rivals."""
        return tuple(rival.label for rival in self.rivals)


_MS = APF_RIVALS[-1]
OWN_SIGMA_V = "the paper's rule, rivals with their own sigma_v"
"""Name of the comparison with rivals that have the likelihood of their own papers."""
COMPARISONS = (
    *(Comparison(name, system, APF_RIVALS) for name, system in INTERPRETATIONS.items()),
    Comparison(OWN_SIGMA_V, APF, (*OWN_LIKELIHOOD, _MS)),
    Comparison(
        "the paper's rule, rivals with their papers' options", APF,
        (LIBERTIES[2], LIBERTIES[1], LIBERTIES[0], APF_RIVALS[3], _MS),
    ),
)  # fmt: skip
"""APF under every interpretation against rivals of one likelihood, and in other company."""

SPEEDS_PER_SIGMA = 1.5
"""Nominal speeds in a sigma: of three rules that follow the speed, this one has the least error of
all six trackers together (laboratory/notes/reproduction.md)."""
LEAST_SIGMA, LARGEST_SIGMA = 5.0, 10.0
"""The paper's interval for sigma, px/frame."""
SIGMA_RULE = (
    f"One rule sets sigma for every tracker that has one: {SPEEDS_PER_SIGMA:g} times the vehicle's "
    f"nominal speed, within the paper's interval from {LEAST_SIGMA:g} to {LARGEST_SIGMA:g} "
    f"px/frame. All have the same likelihood (`sigma_v` {SIGMA_V:g}). Everything else is each "
    "variant's default. " + INTERPRETATIONS_NOTE
)
_SIGMA = {"apf": "motion.sigma_w", "ms": None}


def with_sigma(system: System, sigma: float) -> System:
    """Set the spread of `system` unless it has one of its own; mean shift has none."""
    name = _SIGMA.get(system.variant, "sigma")
    return system if name is None or name in dict(system.settings) else system.but({name: sigma})


def sigma_of(system: System) -> float | None:
    """Return the spread that `with_sigma` has set; None where there is none."""
    sigma = dict(system.settings).get(_SIGMA.get(system.variant, "sigma") or "")
    return None if sigma is None else float(sigma)


def ruled(scene: SceneChoice, system: System, seed: int, record: tuple[str, ...] = ()) -> RunCell:
    """Make the cell of `system` on `scene` with the sigma that the rule gives."""
    sigma = min(max(SPEEDS_PER_SIGMA * scene.speed, LEAST_SIGMA), LARGEST_SIGMA)
    return RunCell(scene, with_sigma(system, sigma), seed, record)
