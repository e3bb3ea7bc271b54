"""Trackers: their contract, the variants, and the registry."""
