"""Statistics of repeated runs: intervals, paired tests, ranks."""
