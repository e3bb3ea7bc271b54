# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The stress battery: from a few sequences with truth, about fifty cases of each.

A *case* is a small frozen description; its frames are made one by one when asked for, so that
nothing large is stored, and the same case always gives the same frames and the same truth.

>>> from laboratory.stress import (                    # doctest: +SKIP
...     find_sequences, quick_battery, run_battery, run_case, score_case, variant_system)
>>> sources = find_sequences("sequences", cameras=None)       # or Path("cameras.csv")
>>> cases = quick_battery(sources)                            # or full_battery, list_cases
>>> case = cases[0]
>>> for frame, elapsed, truth in case.play():                 # RGB uint8, float, Truth or None
...     ...
>>> case.start_box(), case.fps, case.truths(), case.kind, case.camera, case.label("path")
>>> score_case(case, estimates)                               # one Estimate per frame
>>> run_case(case, StressSystem("mine", MyTracker), seed=0)   # MyTracker(seed) -> start, step
>>> results = run_battery(cases, [variant_system("fusion", {"num_particles": 50})],
...                       seeds=range(3), workers=2, store=Path("scores.jsonl"))
>>> [(r.case.name, r.system, r.seed, r.score.on_target, r.score.recovered) for r in results]
>>> for group in groups(results):                             # all, kind, path, occlusion, camera
...     group.system, group.by, group.name, group.summary("on_target"), group.recoveries
...     group.reliability().calibration_error, group.reliability().diagram()
>>> difference(results, "fusion", "fusion without turns", "mean_iou")   # paired, over cameras

What lies where, from footage to report:

- `footage` finds and opens sequences; `cases` describes a case, and plays it with its `changes`.
- `kinds` are the kinds of cases, and `battery` chooses among them. `occlusion_cases` have an
  `occluder` that `placing` puts before the vehicle, over the motion of the `background`; `painting`
  makes its texture, and `coverage` says what it hides.
- `systems` are under test, `fusion` also with an `other_network`; `running` runs them; `scoring`
  judges each run, with the `calibration` of its confidence.
- `summary` means scores over cameras, `report` writes the files, and `command` is
  ``python -m laboratory stress``.

Cases are frozen and picklable: to save the minute that listing a full battery takes, pickle them.
`laboratory/notes/stress.md` lists the kinds of cases and the measures.
"""

from laboratory.stress.battery import full_battery, list_cases, quick_battery
from laboratory.stress.calibration import Reliability
from laboratory.stress.cases import Case, StressFrame
from laboratory.stress.footage import StressSource, find_sequences
from laboratory.stress.kinds import STRESS_KINDS, Kind
from laboratory.stress.running import Result, follow, run_battery, run_case
from laboratory.stress.scoring import Score, score_case, score_estimates
from laboratory.stress.summary import CASE_MEASURES, Group, difference, groups
from laboratory.stress.systems import Follower, StressSystem, variant_system

__all__ = [
    "CASE_MEASURES",
    "STRESS_KINDS",
    "Case",
    "Follower",
    "Group",
    "Kind",
    "Reliability",
    "Result",
    "Score",
    "StressFrame",
    "StressSource",
    "StressSystem",
    "difference",
    "find_sequences",
    "follow",
    "full_battery",
    "groups",
    "list_cases",
    "quick_battery",
    "run_battery",
    "run_case",
    "score_case",
    "score_estimates",
    "variant_system",
]
