# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types and rules that every room uses: frames, boxes, stamps, ground truth, input errors.

It imports no other room. docs/development.md lists the rooms, and what each of them may import.

- `frame`, `box`, `truth`, `array`: the types; `overlaps` of many boxes
- `clock`: elapsed time from stamps; `association`: truth and estimates by stamp; `cdr`: the stamp
  of a serialized message
- `errors`: mistakes of users; `outputs`: which files a command may replace; `addresses` without
  passwords
- `progress` and `signals` of long work; `products`: sums with the same bits on any number of
  threads; `version`
"""
