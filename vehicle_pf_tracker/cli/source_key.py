# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Key of the results of one source: a digest of all that decides them."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.cli.source_lists import NOT_DECISIVE, SeveralSources
from vehicle_pf_tracker.evaluation.cache_key import result_key, variant_modules
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.workers.cluster import fingerprint


def key_of(request: SeveralSources, variant: Variant, configuration: Configuration) -> str:
    """Digest all that decides the results: source, options, code and versions."""
    options = {declared.name: getattr(request, declared.name) for declared in fields(request)}
    decisive = {name: value for name, value in options.items() if name not in NOT_DECISIVE}
    values = {**configuration.to_mapping(), **decisive}
    facts = {
        "source": _stamp(request.source),
        "options": {name: repr(_content(value)) for name, value in sorted(values.items())},
        "made on": _own_fingerprint(),
    }
    return result_key(facts, variant_modules(variant))


_own_fingerprint = functools.cache(fingerprint)


def _stamp(source: str) -> Any:
    """Name the content of a source by names, sizes and times: reading it would take hours."""
    path = Path(source)
    if is_url(source) or not path.exists():
        return source
    files: Iterable[Path] = sorted(path.rglob("*")) if path.is_dir() else [path]
    states = [(file.name, file.stat()) for file in files if file.is_file()]
    return [[name, state.st_size, state.st_mtime_ns] for name, state in states]


def _content(value: Any) -> Any:
    """Return a value, or the text of the file that it names."""
    if isinstance(value, Path | str) and os.path.isfile(value):  # noqa: PTH113 - any text
        return Path(value).read_bytes()
    return value
