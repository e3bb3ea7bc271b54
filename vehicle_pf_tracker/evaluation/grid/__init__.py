"""The grid of an evaluation: recordings by systems by seeds, each cell one stored run.

`sources` finds the recordings, `systems` says what follows a vehicle in them, and `plan` makes the
cells of both. `tracking` runs one cell, `running` all that are missing, on this machine or on a
cluster (`cluster`), and `store` keeps each under the key of all that decides it.
"""
