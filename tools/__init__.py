# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs for those who work on the package; not installed.

- `generate` (``make config``) writes what follows from the code: configurations, `sros2_policy`,
  `parameters_page`, `variant_tables` of pages, and the picture of the `rooms` (`rooms_layout` says
  where each stands, `rooms_picture` draws it).
- `animation`: the README's animation; `website`: pages of the site (``make docs``).
- `licence_headers`: headers of new files; `mutants`: changes that no test notices.
- `release_check`: the checks before a tag, which are in `release/`.
- `detector_wheel`: a network as a package of its own.
"""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
"""Folder of the checkout."""
