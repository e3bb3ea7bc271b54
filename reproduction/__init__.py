"""The papers' experiments: runs, data, figure and verdict of each, by name (`catalogue`).

An experiment is a module with an `EXPERIMENT` that `catalogue` lists. It has two functions. `cells`
gives what has to be run for a `Size`, usually `RunCell` objects: a scene, a tracker, a seed, and
the scalars of the estimates to be recorded. `report` turns their results into data, a figure and a
`Verdict`. `running` runs the cells in processes, each scene rendered once for all of them, and
`store` keeps every result under the key of all that decides it. So what is interrupted goes on, and
only what changed is run anew.
"""
