# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The papers' experiments: runs, data, figure and verdict of each, by name (`catalogue`).

An experiment is a module with an `EXPERIMENT` that `catalogue` lists. It has two functions. `cells`
gives the runs of a `Size`, usually `RunCell` objects: a scene, a tracker, a seed, and the scalars
of the estimates to record. `report` turns their results into data, a figure and an
`ExperimentVerdict`. `running` runs the cells in processes, each scene rendered once for all of
them, and stores every result under its cache key, so that interrupted work continues and only what
changed is rerun.
"""
