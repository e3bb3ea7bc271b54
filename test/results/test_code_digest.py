# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The digest of code: what Python executes counts, what is written about it does not."""

import time
from pathlib import Path

import pytest

import vehicle_pf_tracker
from vehicle_pf_tracker.results.code_digest import code_digest

CODE = '''"""A module."""
SIZE = 3
"""Size, px."""


def area(side):
    """Area."""
    if side:
        side += 1
    return side * SIZE
'''


def digest(folder, text, name="a.py"):
    path = folder / "code.py"
    path.write_text(text, encoding="utf-8")
    return code_digest([(name, path)])


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('"""A module."""\n', ""),
        ('"""Size, px."""', '"""Width, px."""'),
        ('    """Area."""\n', '    """Area.\n\n    In px².\n    """\n'),
        ("SIZE = 3\n", "# Chosen by hand.\nSIZE = 3  # px\n"),
        ("return side * SIZE", "return (\n        side\n        * SIZE\n    )"),
        ("SIZE = 3", "SIZE = 0x3"),
    ],
)
def test_words_about_code_and_its_layout_do_not_count(tmp_path, before, after):
    assert before in CODE
    assert digest(tmp_path, CODE.replace(before, after, 1)) == digest(tmp_path, CODE)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("SIZE = 3", "SIZE = 4"),
        ("SIZE = 3", "SIZE = 3.0"),
        ("SIZE = 3", "SIZE = '3'"),
        ("side * SIZE", "SIZE * side"),
        ("side += 1", "side -= 1"),
        ("    return side", "        return side"),
        ("def area(side)", "def area(size, side)"),
        ("def area(side)", "def area(side=None)"),
        ('    """Area."""\n', "    print('Area.')\n"),
    ],
)
def test_what_python_executes_counts(tmp_path, before, after):
    assert before in CODE
    assert digest(tmp_path, CODE.replace(before, after, 1)) != digest(tmp_path, CODE)


def test_of_what_was_learnt_every_byte_counts(tmp_path):
    weights = tmp_path / "weights.npz"
    digests = set()
    for content in (b"\0\1", b"\0\2", b"# no Python ("):
        weights.write_bytes(content)
        digests.add(code_digest([("weights.npz", weights)]))
    assert len(digests) == 3


def test_the_name_of_a_file_counts_and_the_order_of_files_does_not(tmp_path):
    assert digest(tmp_path, CODE, "b.py") != digest(tmp_path, CODE)
    files = [(name, tmp_path / name) for name in ("a.py", "b.py")]
    for name, path in files:
        path.write_text(f"NAME = {name!r}\n")
    assert code_digest(files) == code_digest(reversed(files))


def test_a_second_digest_of_the_same_code_takes_no_time():
    """Workers ask before each task; the first takes a second, as 400 files are parsed."""
    package = Path(vehicle_pf_tracker.__file__).parent
    files = [(str(path), path) for path in package.rglob("*.py")]
    first = code_digest(files)
    began = time.process_time()
    assert code_digest(files) == first
    assert time.process_time() - began < 0.3
