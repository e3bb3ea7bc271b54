# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Checks before a release is tagged, each by what it looks at.

- `checkout`: what git has, the version that its files state, the generated pages.
- `archives`: the wheel and the source archive, as `make dist` leaves them.
- `installation`: an archive in a fresh `environment`: its size, the `licences` of all that came
  with it, and the README's way in (`journeys`).
- `commands`: how all of them run what they ask.
"""
