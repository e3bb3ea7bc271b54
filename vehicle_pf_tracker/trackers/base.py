# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Common frame of all trackers, around the step in which they differ.

A frame goes in, an estimate comes out.
"""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES, Ancestors
from vehicle_pf_tracker.filtering.weights import Weights, effective_sample_size
from vehicle_pf_tracker.image.kernels.interface import load_kernels
from vehicle_pf_tracker.image.windows.colour import JointColour
from vehicle_pf_tracker.image.windows.mean_shift import kernel_histogram
from vehicle_pf_tracker.image.windows.similarity import Histogram, Reference
from vehicle_pf_tracker.image.windows.window import Window, is_outside, keep_inside
from vehicle_pf_tracker.parameters.table import specs, to_mapping
from vehicle_pf_tracker.trackers.estimate import START_REGIME, Estimate, Mode, read_only
from vehicle_pf_tracker.trackers.evidence import EvidenceJudge
from vehicle_pf_tracker.trackers.parameters import ParametersT, ParticleParameters, WindowParameters

_MARGIN = 64
"""Least margin kept around the target, in px, so that a wider window can still be measured: of
small targets, windows of several times their size."""


class Target:
    """Patch of the first frame around the target.

    References can be rebuilt from it when window, bins or features change while tracking, without
    learning whatever hides the target by then.

    Parameters
    ----------
    frame : (H, W, 3) array
        First frame; the part that is kept is copied.
    box : Box
        Box of the target in it.
    """

    def __init__(self, frame: Frame, box: Box) -> None:
        width, height = frame_size(frame)
        # The target's own size at least: a search region or a wider window lies around it.
        margin = max(_MARGIN, math.ceil(max(box.width, box.height)))
        left = max(math.floor(box.x) - margin, 0)
        top = max(math.floor(box.y) - margin, 0)
        right = min(math.ceil(box.x + box.width) + margin, width)
        bottom = min(math.ceil(box.y + box.height) + margin, height)
        self.box = box
        # A copy of the part, not of the frame: it is kept as long as the track.
        self.patch: Frame = frame[top:bottom, left:right].copy()
        # In coordinates of the patch, where references are measured again.
        self.centre = box.centre[0] - left, box.centre[1] - top

    def window(self, size: WindowParameters) -> Window:
        """Return the window of the given size; where that is 0, of the target's own."""
        return Window.of_size(size.width or self.box.width, size.height or self.box.height)

    def joint_histogram(self, window: Window, bits: int) -> Histogram:
        """Return the joint RGB histogram of the target in the first frame."""
        centre = np.asarray([self.centre])
        return np.asarray(JointColour(bits).histograms(self.patch, centre, window)[0])

    def kernel_reference(self, window: Window, bits: int) -> Reference:
        """Return the reference of mean shift: the same histogram, weighted with its kernel."""
        return Reference(kernel_histogram(self.patch, self.centre, window, bits))


ParticleParametersT = TypeVar("ParticleParametersT", bound=ParticleParameters)


@dataclass(frozen=True, slots=True)
class Cloud:
    """Particle positions (N, 2) in px and normalised weights (N,).

    `sound` is False where the weights carry no information.
    """

    positions: Array
    weights: Array
    sound: bool = True

    @classmethod
    def uniform(cls, positions: Array) -> Cloud:
        """Cloud of equal weights."""
        return cls(positions, np.full(len(positions), 1.0 / len(positions)))

    def mean(self) -> tuple[float, float]:
        """Weighted mean of the positions (P1 eq. 5)."""
        # A dot product of BLAS would depend on its threads.
        x, y = np.einsum("i,ij->j", self.weights, self.positions).tolist()
        return x, y


@dataclass(frozen=True, slots=True)
class Outcome:
    """Result of a variant's step, which the base turns into an `Estimate`.

    Attributes
    ----------
    cloud : Cloud
        Particles after weighting, before the next resampling.
    position : (float, float)
        Estimated centre in px.
    velocity : (float, float)
        Velocity in px per nominal frame period.
    regime : str
        Branch that the paper's algorithm is in.
    evidence : float
        Similarity of the image at `position` to the reference, 0 to 1.
    similarities : mapping of str to float
        Similarities that the algorithm decides by.
    resampling_passes, resampled_particles : int
        Number of resamplings in the step, and of particles that they replaced.
    left_image : bool
        True where the cloud's mean crossed the border before it was clipped.
    size : (float, float) or None
        Width and height of the estimated box in px; None: those of the target.
    """

    cloud: Cloud
    position: tuple[float, float]
    velocity: tuple[float, float]
    regime: str
    evidence: float
    similarities: Mapping[str, float]
    resampling_passes: int = 0
    resampled_particles: int = 0
    left_image: bool = False
    size: tuple[float, float] | None = None


class BaseTracker(ABC, Generic[ParametersT]):
    """Start, time, mode and reconfiguration of a tracker.

    A variant adds `_learn`, `_scatter` and `_advance`.

    Parameters
    ----------
    parameters : ParametersT
        Parameters of the variant.

    Attributes
    ----------
    seed : int
        Seed in use.
    frame_period : float
        Nominal time between frames in s; the reader of the stamps keeps it up to date.
    kernels : Kernels
        Implementation that measures windows, ready for use.
    """

    def __init__(self, parameters: ParametersT) -> None:
        self.parameters = parameters
        self.frame_period = DEFAULT_PERIOD
        self.seed = drawn_seed(parameters.seed)
        # One generator for all draws of a tracker: same seed and frames, same bits.
        self._rng = np.random.default_rng(self.seed)
        self.kernels = load_kernels(parameters.kernels)
        self._target: Target | None = None
        self._window: Window | None = None
        self._first_frame: Frame | None = None
        """Copy of the first frame, until the next one comes."""
        self._judge = EvidenceJudge()
        self._cloud = Cloud.uniform(np.zeros((1, 2)))

    @property
    def _settings(self) -> ParametersT:
        """Effective parameters."""
        return self.parameters.effective()

    @property
    def target(self) -> Target:
        """Target as it was in the first frame.

        Raises
        ------
        RuntimeError
            If the tracker was not started.
        """
        if self._target is None:
            raise RuntimeError("start the tracker on a first frame before stepping it")
        return self._target

    @property
    def window(self) -> Window:
        """Window that features are taken from."""
        return self._window or self.target.window(self.parameters.window)

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target `box` in `frame`, with the random numbers restarted.

        Raises
        ------
        InputError
            If the box cannot be a target in this frame.
        """
        began = time.perf_counter()
        # Before anything is changed: a refused box leaves the track as it is.
        check_target(box, *frame_size(check_frame(frame)))
        self._target = Target(frame, box)
        # Kept until the next frame: new parameters before it start again, see `reconfigure`.
        self._first_frame = frame.copy()
        self._window = self._target.window(self.parameters.window)
        # From the seed again: a restart repeats the first start, to the last bit.
        self._rng = np.random.default_rng(self.seed)
        self._judge = EvidenceJudge()
        self._cloud = Cloud.uniform(keep_inside(frame, self._scatter(box.centre)))
        self._learn()
        # The centre of a box half outside the image may be outside, too.
        x, y = keep_inside(frame, np.asarray(box.centre))
        outcome = Outcome(self._cloud, (float(x), float(y)), (0.0, 0.0), START_REGIME, 1.0, {})
        return self._estimate(outcome, Mode.TRACKING, 1.0, began)

    def step(self, frame: Frame, elapsed: float = 1.0) -> Estimate:
        """Find the target in the next frame, `elapsed` nominal frame periods later."""
        began = time.perf_counter()
        outcome = self._advance(check_frame(frame), elapsed)
        self._first_frame = None
        # Waiting is counted in seconds, since thresholds hold for every frame rate.
        seconds = elapsed * self.frame_period
        # The variant says it, since only there the mean is known before it is clipped.
        left_image = outcome.left_image
        mode = self._judge.judge(outcome.evidence, seconds, self.parameters, left_image=left_image)
        # Weights without information say nothing of where the vehicle is.
        confidence = self._judge.confidence(outcome.evidence) if outcome.cloud.sound else 0.0
        estimate = self._estimate(outcome, mode, confidence, began)
        # Last: a step that fails leaves the cloud of the frame before.
        self._cloud = outcome.cloud
        return estimate

    def reconfigure(self, parameters: ParametersT) -> None:
        """Take new parameters between two frames; the track goes on.

        Before the second frame nothing has been followed yet, and the tracker starts with them.
        """
        # The table says what each parameter needs: nothing, references or random numbers.
        table = specs(type(parameters))
        # What is in effect counts: a switch such as `as_printed` changes others unseen.
        before = to_mapping(self._settings)
        new = to_mapping(parameters.effective())
        changed = {table[name].effect for name in new if before[name] != new[name]}
        self.parameters = parameters
        self.kernels = load_kernels(parameters.kernels)
        if "restarts" in changed:
            self.seed = drawn_seed(parameters.seed)
            self._rng = np.random.default_rng(self.seed)
        # Started again with the same numbers, as if the new parameters had been there first.
        if self._first_frame is not None:
            self.start(self._first_frame, self.target.box)
        elif self._target is not None and "relearns" in changed:
            self._window = self._target.window(parameters.window)
            self._judge.measures_anew()
            self._learn()

    @abstractmethod
    def _learn(self) -> None:
        """Build the references from `self.target`."""

    @abstractmethod
    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take the algorithm's step from the cloud `self._cloud`."""

    @abstractmethod
    def _scatter(self, centre: tuple[float, float]) -> Array:
        """Draw the first particles around `centre`, shape (N, 2) in px."""

    def _move(self, frame: Frame, positions: Array, moves: Array) -> tuple[Array, bool]:
        """Displace particles inside the image; also True if their mean crossed its border."""
        # The mean is taken before positions are clipped, which would keep it inside for ever.
        proposed = positions + moves
        # Summed thus, it takes half of the time of `sum`: rows are as short as two.
        x, y = (np.einsum("ij->j", proposed) / len(proposed)).tolist()
        return keep_inside(frame, proposed), is_outside(frame, x, y)

    def _estimate(self, outcome: Outcome, mode: Mode, confidence: float, began: float) -> Estimate:
        target = self.target.box
        x, y = outcome.position
        box = Box.around(outcome.position, *outcome.size or (target.width, target.height))
        # Of the weights before resampling: afterwards all are equal.
        effective = effective_sample_size(outcome.cloud.weights)
        # A weight that is not finite leaves no effective particles, a position no finite sum.
        if not (effective > 0 and math.isfinite(x + y + outcome.cloud.positions.sum())):
            raise ArithmeticError(
                f"{type(self).__name__} gave particles, weights or a position that are not finite"
            )
        return Estimate(
            position=outcome.position,
            box=box,
            velocity=outcome.velocity,
            mode=mode,
            regime=outcome.regime,
            confidence=confidence,
            similarities=outcome.similarities,
            effective_sample_size=effective,
            resampling_passes=outcome.resampling_passes,
            resampled_particles=outcome.resampled_particles,
            # Views, since a caller that wrote to them would change the next step.
            particles=read_only(outcome.cloud.positions),
            weights=read_only(outcome.cloud.weights),
            duration=time.perf_counter() - began,
        )


class ParticleTracker(BaseTracker[ParticleParametersT]):
    """A tracker whose cloud has `num_particles` particles, also when that number changes."""

    def reconfigure(self, parameters: ParticleParametersT) -> None:
        """Take new parameters; another number of particles is drawn from the present cloud."""
        super().reconfigure(parameters)
        if self._target is not None and len(self._cloud.weights) != parameters.num_particles:
            # Systematic: a change of the number alone then keeps the cloud's shape best.
            ancestors = self._draw(self._cloud.weights, "systematic")
            self._cloud = Cloud.uniform(self._cloud.positions[ancestors])

    def _draw(self, weights: Weights, scheme: str) -> Ancestors:
        """Draw the particles that the next ones come from by a named scheme, as indices."""
        return RESAMPLING_SCHEMES[scheme](weights, self.parameters.num_particles, self._rng)


def drawn_seed(seed: int) -> int:
    """Return the seed to use: another one in each run where `seed` is -1."""
    return seed if seed >= 0 else int(np.random.default_rng().integers(2**31))
