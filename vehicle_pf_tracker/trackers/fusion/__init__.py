"""`fusion`, the flagship: a correlation particle filter with a posterior over visibility."""
