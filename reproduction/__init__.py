# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The papers' experiments: runs, data, figure and verdict of each, by name (`catalogue`).

The first paper is Scharcanski et al. 2011 (P1: `apf/`), the second Abdulla et al. 2022 (P2:
`mfpf/`), the third Khong et al. (P3: `resampling/`). The `systems` of each has its trackers, the
interpretations that its claims are judged under, and its scenes; its `paper` lists its experiments.

An experiment is a module with an `EXPERIMENT`, a value of `experiment`. It has two functions.
`cells` gives the runs of a `Size`, usually `RunCell` objects: a scene, a tracker, a seed, and the
scalars of the estimates to record. `report` turns their results into data, a figure and an
`ExperimentVerdict`, by `numbers` and `drawing/`. `runs/` runs the cells in processes, each scene
rendered once for all of them, and stores every result under its cache key, so that interrupted work
continues and only what changed is rerun.

`pages/` writes an experiment's folder, and joins the verdicts to docs/reproduction.md. The scenes
that only the experiments need are in `scenes/`. Programs of their own are `effects` (what each
interpretation changes), `demo_sigma` (the best sigma of the demonstration's `pf`) and `sequences`
(the page of real sequences).

In most of them `_cell` names a run, `_figure` draws, `_verdict` or `_claims` lists the claims, and
a function for each claim judges it under one interpretation, as a `Finding`.
"""
