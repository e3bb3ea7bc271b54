# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Kernels are linked where they were compiled before, and trust nothing that they are given."""

import subprocess
import sys
from types import ModuleType

import numpy as np
import pytest

from vehicle_pf_tracker.image.kernels.toolchain.arguments import ArrayForm, check
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined, notices
from vehicle_pf_tracker.image.kernels.toolchain.object_code import ObjectCode, from_bytes, to_bytes

REALS = ArrayForm(0, None, np.dtype("<f8"), 1, is_packed=True, is_written=False)
COUNTS = ArrayForm(2, 0, np.dtype("<i4"), 2, is_packed=False, is_written=True)
CODE = ObjectCode(b"\n\0code", "w", "e", ("<f8",), (REALS, COUNTS), ("sqrt", "memset"))


def test_arrays_of_their_forms_are_taken():
    check((REALS, COUNTS), (np.zeros(3), 5, (np.zeros((4, 6), np.int32)[:, ::2], 1)))


@pytest.mark.parametrize(
    "value",
    [np.zeros(3, np.float32), np.zeros(3, np.int64), np.zeros((3, 1)), np.zeros(6)[::2]],
)
def test_arrays_of_other_forms_are_refused(value):
    with pytest.raises(TypeError, match="a kernel takes an array as"):
        check((REALS,), (value,))


def test_an_array_that_cannot_be_written_is_refused():
    with pytest.raises(TypeError, match="a kernel takes an array as"):
        check((COUNTS,), (0, 0, (np.broadcast_to(np.int32(1), (2, 2)),)))


def test_object_code_is_what_it_was_when_it_is_read_and_nothing_when_torn():
    written = to_bytes(CODE)
    assert from_bytes(written) == CODE
    assert from_bytes(written[:-1]) is None
    assert from_bytes(b"") is None


@pytest.fixture
def module():
    """A module with a kernel, its part and a number."""
    made = ModuleType("made_for_a_test")
    exec(
        "FACTOR = 2\ndef times(number): return FACTOR * number\ndef twice(number): ...",
        vars(made),
    )
    sys.modules[made.__name__] = made
    made.times = inlined(made.times)
    made.twice = compiled("int64", "int64")(made.twice)
    yield made
    del sys.modules[made.__name__]


def test_code_follows_from_the_texts_numbers_and_types(module, monkeypatch):
    texts = {}
    name = "vehicle_pf_tracker.image.kernels.toolchain.kernel.inspect.getsource"
    monkeypatch.setattr(name, lambda module: texts[module.__name__])
    texts[module.__name__] = "text"
    before = module.twice.source
    module.FACTOR = 3
    assert module.twice.source != before
    module.FACTOR = 2
    assert module.twice.source == before
    texts[module.__name__] = "another text"
    assert module.twice.source != before
    texts[module.__name__] = "text"
    other = compiled("float64", "float64")(module.twice.function)
    assert other.source != before


def test_a_change_of_a_part_in_another_module_counts(module, monkeypatch):
    other = ModuleType("made_beside")
    exec("def half(number): return number", vars(other))
    monkeypatch.setitem(sys.modules, other.__name__, other)
    texts = {module.__name__: "text", other.__name__: "text"}
    name = "vehicle_pf_tracker.image.kernels.toolchain.kernel.inspect.getsource"
    monkeypatch.setattr(name, lambda module: texts[module.__name__])
    module.half = inlined(other.half)
    before = module.twice.source
    texts[other.__name__] = "another text"
    assert module.twice.source != before


@pytest.fixture
def without_notices(monkeypatch):
    monkeypatch.setattr("vehicle_pf_tracker.image.kernels.toolchain.kernel._notices", [])


def test_a_numba_whose_code_cannot_be_taken_or_linked_is_told_of(
    module, monkeypatch, without_notices
):
    pytest.importorskip("numba", reason="numba is not installed")
    room = "vehicle_pf_tracker.image.kernels.toolchain"
    linking = pytest.importorskip(f"{room}.linking")
    monkeypatch.setattr(f"{room}.kernel_store.read", lambda *key: CODE)

    def cannot(*values):
        raise linking.LinkError("nothing here is called NRT_New")

    monkeypatch.setattr(f"{room}.linking.linked", cannot)
    compilation = pytest.importorskip(f"{room}.compilation")
    monkeypatch.setattr(compilation, "compiled_by_numba", lambda *values: module.twice.function)
    monkeypatch.setattr(compilation, "is_disabled", lambda: True)
    monkeypatch.setattr(f"{room}.kernel.inspect.getsource", lambda module: "text")
    assert module.twice(4) is None  # its Python
    (told,) = notices()
    assert "cannot be linked in later processes (nothing here is called NRT_New)" in told


PROGRAM = """
import sys
import numpy as np
from vehicle_pf_tracker.image.kernels import numba_counts
numba_counts.compare_counts.prepare()
assert ("numba" in sys.modules) == (sys.argv[1] == "first"), sys.argv
counts = np.array([[3, 1, 0], [0, 0, 4]], np.int32)
scale = np.sqrt([0.75, 0.25, 0.0]), np.sqrt(np.arange(9.0))
for arguments in [(counts, np.array([4.0, 4.0]), scale), (counts.T, np.array([4, 4]), scale)]:
    try:
        numba_counts.compare_counts(*arguments)
        print("taken")
    except TypeError as error:
        pass
for totals in ([4, 4], [4, 4, 4]):
    for _ in range(300):
        try:
            print(*numba_counts.compare_counts(counts, np.array(totals), scale).round(9))
        except IndexError as error:
            print(error)
# numba itself beside linked code, in one process.
import numba
assert numba.njit("float64(float64[::1])")(lambda values: values.sum())(np.ones(3)) == 3
print(numba_counts.compare_counts(counts, np.array([4, 4]), scale).round(9))
"""


def test_linked_code_gives_and_raises_what_compiled_code_does(tmp_path):
    pytest.importorskip("numba", reason="numba is not installed")
    told = []
    for start in ("first", "second"):
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, start],
            env={"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": ":".join(sys.path)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr[-2000:]
        told.append(done.stdout.splitlines())
    # (3 + 1) / 4 of the reference, and what lies in a bin that it has not.
    assert told[0] == ["1.0 0.0"] * 300 + [
        "the counts are not those of the reference's cells"
    ] * 300 + ["[1. 0.]"]
    assert told[1] == told[0]
