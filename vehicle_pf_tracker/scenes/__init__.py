"""Synthetic traffic with exact truth."""
