"""Whole numbers on a command line."""

from __future__ import annotations

import argparse


def positive(text: str) -> int:
    """Read a whole number from 1 on."""
    return _at_least(1, text)


def natural(text: str) -> int:
    """Read a whole number from 0 on."""
    return _at_least(0, text)


def _at_least(least: int, text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from {least} on")
    return int(text)
