# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Synthetic traffic with exact truth; `catalogue` has the scenes by name.

    scene = make_scene("bridge", seed=1)
    for shown in scene.frames():
        shown.frame, shown.truth

Each room builds on those below it:

- scenes: `bar`, `highway` and `drive_scenes`. Most are a `drive`: a target on its way along a road,
  and the means to put things around it.
- what is seen in them: `roads` on `grounds`, `obstacles`, `lane_traffic` that keeps its lane, and a
  `turning_vehicle`; `vehicles` of `vehicle_parts` are `solids`. `courses` say where each is.
- how a picture comes about: a `scene` has actors on paths; `compositing` paints their sprites at
  exact sub-pixel positions, from `polygons` alike on every machine; `cameras` add noise, shaking
  and flicker.

All that is left to chance comes from `random_streams`: the same scene, settings and seed are
bit-identical, and test/scenes/test_first_scenes_stay.py holds pixels. A new scene is a function of
its parameters and a seed, and an entry in `catalogue`.
"""
