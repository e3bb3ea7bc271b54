# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs about `fusion`, which follows one vehicle.

Each is run by its name, as `python -m laboratory.fusion.fit`:

- `fit`: its numbers, judged on cameras left out
- `reliability`: what the shipped numbers reach, and how far the confidence is right
- `ablation`: what each part contributes, and `mechanisms` each of those before standing cameras
- `clips`: whether it knows that its vehicle has left, in clips without truth
- `scenes`: what it reaches on synthetic scenes, with `scene_pictures` of them

Those over recordings share `options` of the command line, `case_lists` and the `score_table`. What
is tried in a fit are `settings`, by the `objective`.
"""
