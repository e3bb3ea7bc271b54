"""`params`: the default parameters of a variant, as a ROS parameter file or as a table."""

from __future__ import annotations

import argparse

from vehicle_pf_tracker.cli.config_files import config_path
from vehicle_pf_tracker.trackers.parameter_files import to_yaml
from vehicle_pf_tracker.trackers.parameters import ParameterSpec
from vehicle_pf_tracker.trackers.registry import Variant, find_variant


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    parser.add_argument("variant", help="name of the variant, apf for instance")
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument(
        "--path", action="store_true", help="print where the installed parameter file is"
    )
    forms.add_argument(
        "--markdown", action="store_true", help="print a table for documents, not YAML"
    )


def run(args: argparse.Namespace) -> int:
    """Print what is asked for."""
    variant = find_variant(args.variant)
    if args.path:
        print(config_path(variant.name))
    elif args.markdown:
        print(default_markdown(variant), end="")
    else:
        print(default_yaml(variant), end="")
    return 0


def default_yaml(variant: Variant) -> str:
    """Write the defaults of the node of `variant` as a commented ROS parameter file."""
    from vehicle_pf_tracker.ros.configuration import Configuration

    defaults = Configuration.of(variant)
    title = f"{variant.name}: {variant.summary}. Printed by `vehicle-pf-tracker params`."
    return to_yaml(defaults.specs(), defaults.to_mapping(), title)


def default_markdown(variant: Variant) -> str:
    """Write the parameters of the node of `variant` as a Markdown table."""
    from vehicle_pf_tracker.ros.configuration import Configuration

    rows = [
        ("parameter", "default", "range", "unit", "what turning it does", "source"),
        ("---",) * 6,
        *map(_row, Configuration.of(variant).specs().values()),
    ]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _row(spec: ParameterSpec) -> tuple[str, ...]:
    default = str(spec.default).lower() if spec.kind is bool else str(spec.default)
    values = ", ".join(spec.choices) or spec.bounds
    cells = (f"`{spec.name}`", default, values, spec.unit, spec.doc, spec.source)
    return tuple(cell.replace("|", "\\|") for cell in cells)
