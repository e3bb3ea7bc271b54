"""Particle filtering in plain numpy: weights, resampling, motion samplers."""
