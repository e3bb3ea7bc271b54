# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Options of the verbs that track: in which part of a source, which targets, with what shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.parameter_options import ParameterOptions, configure
from vehicle_pf_tracker.cli.requests import option
from vehicle_pf_tracker.cli.serving import ServeAddress, parse_token
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, SourceOptions
from vehicle_pf_tracker.cli.source_part import Moment
from vehicle_pf_tracker.cli.target_options import (
    TARGET_FORM,
    TargetOption,
    parse_target,
    read_list,
    target_of,
)
from vehicle_pf_tracker.parameters.configuration import Configuration, SessionParameters
from vehicle_pf_tracker.parameters.table import parse_assignments, specs
from vehicle_pf_tracker.trackers.registry import Variant


@dataclass(frozen=True, kw_only=True)
class TrackingRequest(SourceOptions, ParameterOptions, OverwriteOption):
    """Request to track in a source, or in a part of it."""

    seed: int | None = option(help="seed of the random numbers; -1 draws one and run.json keeps it")
    start: Moment | None = option(
        type=Moment.parse, metavar="AT",
        help="first frame: its number, from 1, or its time in seconds, as 4.3s",
    )  # fmt: skip
    end: Moment | None = option(type=Moment.parse, metavar="AT", help="last frame, likewise")
    target: Sequence[TargetOption] = option(
        type=parse_target, action="append", default=[], metavar="[NAME][@FRAME:]X,Y,W,H",
        help="vehicle to follow: top-left corner and size of its box in px, in the first frame or "
        "in FRAME; repeatable, for several vehicles or to correct one later; run starts on the "
        "first true box otherwise, and traffic follows these beside those that it detects",
    )  # fmt: skip
    targets: Path | None = option(help="targets that `pick` wrote")
    video: Path | None = option(help="write the frames with all that is followed to FILE, an mp4")
    serve: ServeAddress | None = option(
        type=ServeAddress.parse, nargs="?", const=ServeAddress(), metavar="[HOST:]PORT",
        help="show picture and numbers meanwhile on a page for this machine's browsers; without "
        "PORT at any free one, with 0.0.0.0:PORT for other machines, in clear text",
    )  # fmt: skip
    token: str | None = option(
        type=parse_token, metavar="WORD",
        help="secret part of the page's address, instead of a random one",
    )  # fmt: skip

    @property
    def inputs(self) -> tuple[str | Path | None, ...]:
        """The source, and the files that options name."""
        return self.source, self.params, self.targets

    def given_targets(self) -> list[TargetOption]:
        """Collect the targets of the command line and of the file."""
        of_file = read_list(self.targets, "targets", TARGET_FORM, target_of) if self.targets else []
        return [*self.target, *of_file]

    def configuration(self, variant: Variant) -> Configuration:
        """Collect the parameters that are chosen for a variant.

        Raises
        ------
        InputError
            If the file cannot be used, or a name or a value does not fit.
        """
        # Those of the node alone would change nothing here, so they are refused as unknown.
        table = {**specs(variant.parameters), **specs(SessionParameters)}
        values = parse_assignments(table, self.assignments)
        seed = {} if self.seed is None else {"seed": self.seed}
        return configure(variant, [self.params] if self.params else [], {**values, **seed})
