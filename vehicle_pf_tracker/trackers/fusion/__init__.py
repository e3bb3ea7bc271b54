"""The flagship: fused cues, scale, camera motion, and the return from total occlusions."""
