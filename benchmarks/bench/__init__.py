# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speed, memory and cost of the node, as ratios measured in one run: `make bench`.

- a run: `effort` says how much of it, `interleaving` takes two pieces of work in turns; each ratio
  is a `case`, and `results` writes them to bench.json with the `environment`
- trackers: `steps` and `turns` of every variant, `costs` by what they grow with, `startup`, over
  the images of `material`
- windows: `kernels` by their `routes`, against `naive` code and memory's `bandwidth`
- nodes: `nodes` and `delivery`, over the `floor_node`, in `processes` of which `camera` feeds each
  and `metered_node` measures its steps; `resident` memory
- judged: `targets` of speed, and `slower_steps` than before
- shown: `performance_page` with its `figures`; `root` is where processes run
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is first imported
os.environ.setdefault("OMP_NUM_THREADS", "1")
