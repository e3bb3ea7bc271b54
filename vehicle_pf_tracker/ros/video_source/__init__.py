# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node that publishes the images of a video, a folder, a camera or a stream.

`running` is the program, `source_node` the node: it publishes at the source's `pace`, and after an
`outage` opens the source again.
"""
