"""The grid of an evaluation: recordings by systems by seeds, each cell one stored run.

`sources` finds the recordings, `systems` defines what tracks the vehicle in them, and `plan` makes
the cells of both. `tracking` runs one cell, and `running` those that are missing, on this machine
or on a cluster (`cluster`); it stores each under its cache key.
"""
