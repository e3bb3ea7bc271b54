"""The flagship: fused cues, scale, camera motion, and the return from total occlusions."""

from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.tracker import FusionTracker

__all__ = ["FusionParameters", "FusionTracker"]
