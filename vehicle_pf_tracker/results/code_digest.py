# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Digest of Python code as Python reads it: comments, docstrings and layout do not count.

What code has learnt, in files beside it, counts byte by byte.
"""

from __future__ import annotations

import ast
import functools
import hashlib
from collections.abc import Iterable
from pathlib import Path

CODE = ("*.py", "*.npz")
"""Patterns of the files that decide what code computes: itself, and the weights of networks."""


def code_digest(files: Iterable[tuple[str, Path]]) -> str:
    """Digest files of `CODE`, each under a name that counts, too; their order does not.

    Raises
    ------
    SyntaxError
        If one of Python is not Python.
    """
    digest = hashlib.sha256()
    # Sorted, as a set of paths has another order in each process.
    for name, path in sorted(files):
        content = path.read_bytes()
        is_python = path.suffix == ".py"
        own = _tree_digest(content) if is_python else hashlib.sha256(content).digest()
        digest.update(name.encode() + b"\0" + own)
    return digest.hexdigest()


# By the text and not by the path: a worker asks before each task, and files change meanwhile.
@functools.lru_cache(maxsize=1024)
def _tree_digest(source: bytes) -> bytes:
    words: list[str] = []
    _spell(ast.parse(source), words)
    return hashlib.sha256("\0".join(words).encode("utf-8", "surrogatepass")).digest()


def _spell(node: ast.AST, words: list[str]) -> None:
    """Append the types and values of a syntax tree in order, without its lines and columns.

    `ast.dump` says the same in twice the time.
    """
    words.append(type(node).__name__)
    for field in node._fields:
        value = getattr(node, field, None)
        if isinstance(value, ast.AST):
            _spell(value, words)
        elif isinstance(value, list):
            # Both ends of a list are marked: a statement must not slip from one block to the next.
            words.append("[")
            for item in value:
                if not isinstance(item, ast.AST):
                    words.append(repr(item))
                elif not _is_docstring(item):
                    _spell(item, words)
            words.append("]")
        else:
            words.append(repr(value))


def _is_docstring(node: ast.AST) -> bool:
    """Tell a text that stands alone, as below a function's head or a constant: it does nothing."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
