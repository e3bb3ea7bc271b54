"""Searching a variant's parameters on recordings, and what came of it on others."""
