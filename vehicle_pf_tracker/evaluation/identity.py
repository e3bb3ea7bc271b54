"""Under which key a result is kept: a digest of everything that decides it."""

from __future__ import annotations

import functools
import hashlib
import json
import platform
from collections.abc import Iterable, Mapping
from typing import Any

from vehicle_pf_tracker.evaluation.run_info import versions
from vehicle_pf_tracker.evaluation.source_digest import source_digest
from vehicle_pf_tracker.trackers.registry import Variant


def result_key(facts: Mapping[str, Any], modules: Iterable[str]) -> str:
    """Digest facts, the code of `modules`, and the versions of what it runs on."""
    code = code_digest(frozenset(modules))
    made_by = {**versions(), "platform": platform.machine(), "code": code}
    text = json.dumps({**facts, "made by": made_by}, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def variant_modules(variant: Variant) -> set[str]:
    """Name the modules that a variant begins in."""
    return {variant.tracker.__module__, variant.parameters.__module__}


@functools.cache
def code_digest(modules: frozenset[str]) -> str:
    """Digest the code of `modules`, and of all that they import from the package or their own."""
    return source_digest(modules)


def scoring_digest() -> str:
    """Digest the code that makes metrics of estimates."""
    return code_digest(frozenset({"vehicle_pf_tracker.evaluation.metrics"}))
