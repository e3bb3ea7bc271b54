"""Parameters of `fusion`; docs/fusion.md tells what each part is for."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.contract import ParticleParameters
from vehicle_pf_tracker.trackers.evidence import EvidenceParameters


@dataclass(frozen=True, slots=True)
class CueParameters:
    """What the target is known by."""

    anchor: bool = parameter(
        True, "Off: the first frame's template takes no part, and slow drifts are not held."
    )
    following: bool = parameter(
        True, "Off: no template follows the looks of the target, which change as it turns."
    )
    colour: bool = parameter(True, "Off: colours take no part.")
    parts: bool = parameter(
        True, "Off: halves of the template are not compared; half hidden counts as hidden sooner."
    )
    alignment: bool = parameter(
        True, "Off: place and size are not refined to fractions of a pixel; the size lags behind."
    )
    adaptive: bool = parameter(
        True,
        "Off: all cues keep the same weight, also where one does not tell the target from its "
        "surroundings.",
        source="P2 (8)",
    )
    side: float = parameter(
        32.0,
        "Larger: the target is compared at a finer resolution, at more time per frame.",
        minimum=8.0,
        maximum=96.0,
        unit="px",
        effect="relearns",
    )
    template_rate: float = parameter(
        0.06,
        "Higher: the following template takes on changed looks faster, and occluders too.",
        minimum=0.0,
        maximum=1.0,
        unit="per frame",
    )
    colour_rate: float = parameter(
        0.05,
        "Higher: the histograms take on changed colours faster, and occluders too.",
        minimum=0.0,
        maximum=1.0,
        unit="per four frames",
    )


@dataclass(frozen=True, slots=True)
class VehicleMotionParameters:
    """How particles move."""

    camera: bool = parameter(
        True, "Off: the background is taken to stand still; saves time where it does."
    )
    scale: bool = parameter(True, "Off: the box keeps its first size.")
    sigma: float = parameter(
        0.1,
        "Larger: follows jumps of the place; steadier if smaller.",
        minimum=0.001,
        maximum=2.0,
        unit="of the size, per frame",
    )
    velocity_sigma: float = parameter(
        0.04,
        "Larger: follows swifter changes of speed; steadier if smaller.",
        minimum=0.0,
        maximum=1.0,
        unit="of the size, per frame and frame",
    )
    scale_sigma: float = parameter(
        0.02,
        "Larger: follows swifter changes of size; steadier if smaller.",
        minimum=0.0,
        maximum=0.5,
        unit="of the size, per frame",
    )
    gain: float = parameter(
        0.35,
        "Higher: the velocity takes on more of each displacement.",
        minimum=0.0,
        maximum=1.0,
    )


@dataclass(frozen=True, slots=True)
class HidingParameters:
    """How occlusions are entered, borne and left."""

    retrospect: bool = parameter(
        True,
        "Off: the motion while hidden is fitted to the last frames too, which the occluder has "
        "dragged along.",
    )
    projective: bool = parameter(
        True, "Off: velocity and size stay as they were, though the vehicle drives into depth."
    )
    drift: bool = parameter(
        True,
        "Off: hidden particles spread evenly to all sides, not along the motion.",
        source="P1 (11)",
    )
    gate: bool = parameter(
        True,
        "Off: particles are not held to the foretold motion in doubt, and leaving it tells of no "
        "occlusion.",
    )
    background: bool = parameter(
        True,
        "Off: what a still camera saw at a place before the vehicle came there tells nothing.",
    )
    turns: bool = parameter(
        True,
        "Off: a vehicle that turns before a still camera is not followed by its outline, nor "
        "looked for where it comes out of a turn.",
    )
    search: bool = parameter(
        True, "Off: a hidden target is looked for at its predicted place alone."
    )
    confirm: int = parameter(
        3,
        "More: a candidate has to agree in place, size, motion and looks for longer before it is "
        "taken for the target.",
        minimum=2,
        maximum=24,
        unit="frames",
    )
    patience: int = parameter(
        25,
        "Longer: changed looks are doubted for longer before they are taken for the target's.",
        minimum=1,
        maximum=1000,
        unit="frames",
    )


@dataclass(frozen=True, slots=True)
class FusionParameters(ParticleParameters):
    """Parameters of `fusion`."""

    sharpness: float = parameter(
        25.0,
        "Higher: particles that are less alike lose weight faster.",
        minimum=0.1,
        maximum=1000.0,
    )
    resampling_passes: int = parameter(
        1,
        "More: low weights are drawn anew more often within a frame, which sharpens the estimate; "
        "0: never.",
        minimum=0,
        maximum=20,
        source="P3 Table II",
    )
    cues: CueParameters = group(CueParameters)
    motion: VehicleMotionParameters = group(VehicleMotionParameters)
    hiding: HidingParameters = group(HidingParameters)
    evidence: EvidenceParameters = group(EvidenceParameters)
