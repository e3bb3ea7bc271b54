# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Results of a run that never was."""

from benchmarks.bench.case import Case
from benchmarks.bench.delivery import Delivery
from benchmarks.bench.memory import MemoryCase
from benchmarks.bench.results import Results


def results():
    return Results(
        environment={"made": "2026-11-21T14:45:22+00:00", "python": "3.11", "load_average": 0.1},
        commands=["python -m benchmarks.bench"],
        cases=[
            Case("kernel/joint512/41x31/vga/n200", 0.05, 2.5, 50.0, 4.0),
            Case("kernel/joint512/41x31/vga/n1000", 0.2, 10.0, 50.0, 4.0),
            Case("kernel/joint512/41x31/1080p-over-vga/n200", 0.055, 0.05, 0.909, 0.1),
            Case("bandwidth/joint512/41x31/vga/n200", 0.05, 0.002, 0.04, 0.01),
            Case("step/apf/csrt", 0.5, 25.0, 50.0, 2.0),
            Case("step/apf/kcf", 0.5, 1.5, 3.0, 0.2),
            Case("node/apf/without_step", 1.2, 1.0, 0.833, 0.02),
            Case("startup/apf/warm", 900.0, 200.0, 0.222, 0.02),
            Case("startup/apf/numba", 900.0, 420.0, 0.467, 0.02),
            Case("startup/apf/cold", 17820.0, 900.0, 0.05, 0.02),
            Case("cost/particles/apf/n50", 0.1, 0.2, 2.0, 0.2),
            Case("cost/particles/mfpf/n50", 0.3, 1.2, 4.0, 0.2),
        ],
        memory=[MemoryCase("memory/node/apf", 240.0, 76.0)],
        deliveries=[Delivery("fleet/apf/8x640x480", 8, 15.0, 3600, 2, 1.9, 900.0)],
        on_target={"apf": 1.0, "csrt": 0.99, "kcf": 0.5},
    )
