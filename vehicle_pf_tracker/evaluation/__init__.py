"""Metrics, repeated runs, tables and plots."""
