"""Exception for mistakes that a user can correct."""

from __future__ import annotations


class InputError(ValueError):
    """User's mistake, described in one sentence that names the thing and the remedy.

    Raised by every room for bad files, targets, parameters and names. The command line prints the
    sentence on one line and ends with status 1; the node logs it and lives on.
    """
