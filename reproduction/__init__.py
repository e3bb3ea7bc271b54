# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The papers' experiments: runs, data, figure and verdict of each, by name (`catalogue`).

The first paper is Scharcanski et al. 2011 (P1: `apf_*`), the second Abdulla et al. 2022 (P2:
`mfpf_*`), the third Khong et al. (P3: `resampling_*`). The `*_systems` of each has its trackers,
the interpretations that its claims are judged under, and its scenes.

An experiment is a module with an `EXPERIMENT` that `catalogue` lists. It has two functions. `cells`
gives the runs of a `Size`, usually `RunCell` objects: a scene, a tracker, a seed, and the scalars
of the estimates to record. `report` turns their results into data, a figure and an
`ExperimentVerdict`. `running` runs the cells in processes, each scene rendered once for all of
them, and stores every result under its cache key, so that interrupted work continues and only what
changed is rerun.

`output` writes an experiment's folder. `page` joins the verdicts to docs/reproduction.md, in the
words of `page_text`, and keeps them beside it as data.

In most of them `_cell` names a run, `_figure` draws, `_verdict` or `_claims` lists the claims, and
a function for each claim judges it under one interpretation, as a `Finding`.
"""
