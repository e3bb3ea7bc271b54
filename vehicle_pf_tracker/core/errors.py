"""The one exception for mistakes that a user can mend."""

from __future__ import annotations


class InputError(ValueError):
    """A user's mistake, told in one sentence that names the thing and the remedy.

    Raised by every room for bad files, targets, parameters and names. The command line prints the
    sentence on one line and ends with status 1; the node logs it and lives on.
    """
