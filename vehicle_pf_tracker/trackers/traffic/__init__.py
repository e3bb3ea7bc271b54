# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every vehicle in view: found, followed through occlusions, with identities that last."""
