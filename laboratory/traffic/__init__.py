# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs about `traffic`, which follows every vehicle.

Each is run by its name, as `python -m laboratory.traffic.fit`:

- `fit`: its decisions and those of its detectors, judged on cameras left out
- `score`: files of tracks against truth, beside baselines
- `perturbed`: it and the baselines on detections made worse
- `spread`: what changes of no meaning do to its scores
- `clips`: the identity of single vehicles with truth
- `occluders`: whether it says rightly who hides a vehicle
- `joined`: whether it says rightly how many vehicles motion cannot tell apart

What `fit` tries are `decisions`, in `trials` over `camera_clips`; the `decision_table` judges them.
"""
