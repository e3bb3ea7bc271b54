"""What can be concluded from repeated runs: intervals, paired tests, ranks."""
