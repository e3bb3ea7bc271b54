# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command line, one file per verb.

A verb is a module with `run` and a `Request`, whose fields are its options; `main.VERBS` has them.
The other modules hold what several verbs share:

- options: `requests` makes a request of the words, `option_values` reads single ones,
  `shared_options` has those of many verbs, `parameter_options`, `tracking_options`,
  `target_options` and `system_options` those of some
- sources: `source_part` is a part of one; `source_lists` names many, which `many_sources` follows,
  each as a `source_job` that is kept under a `source_key`
- the terminal: `console` prints, `stopping` takes signals, `serving` serves the live page
- `pick_page` and `picked_shapes` are the page of `pick`; `missing_modules` and `network_advice` say
  what to install or to use
"""
