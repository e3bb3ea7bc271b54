# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Networks of a detector: by path, address or name, fetched once, loaded by ONNX Runtime.

`opened_network.open_network` is the way in. `model_files` finds the file, `known_networks` has the
names, and `fetching` fetches.
"""
