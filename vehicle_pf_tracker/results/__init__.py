# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files that a run leaves: tables, summaries and folders.

- any run: `output_files` appear whole or not at all, `run_folder` has run.json
- given targets: `estimates` (estimates.csv, and the summary in words), `trajectories` for evo
- all vehicles: `traffic_results` writes tables row by row, with `backdating`, and `traffic_tables`
  reads them; `traffic_summary` counts them by a `vehicle_log` each
- many sources: `source_table`
- `code_digest`: by which kept results are found again as long as the code is the same

It imports the rooms that track and count, and draws nothing itself.
"""
