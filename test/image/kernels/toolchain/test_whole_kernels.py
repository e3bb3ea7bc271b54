# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machine code of whole kernels alone, and what numba is left as."""

import pytest

from vehicle_pf_tracker.image.kernels.toolchain.kernel import Part, inlined

numba = pytest.importorskip("numba", reason="numba is not installed")

from vehicle_pf_tracker.image.kernels.toolchain import compilation, whole_kernels  # noqa: E402


@inlined
def tripled(value):
    return 3 * value


def larger_tripled(first, second):
    return max(tripled(first), tripled(second))


def compiled():
    is_part = lambda value: isinstance(value, Part)  # noqa: E731
    return compilation.compiled_by_numba(larger_tripled, "int64(int64, int64)", is_part)


@pytest.fixture
def made(monkeypatch):
    """Names of the libraries of which machine code is made."""
    codegen = numba.core.registry.cpu_target.target_context.codegen()
    library = type(codegen)._library_class
    original = library._finalize_final_module
    names = []

    def note(self):
        names.append(self.name)
        original(self)

    monkeypatch.setattr(library, "_finalize_final_module", note)
    return names


def test_a_kernel_has_machine_code_and_its_parts_have_none(made):
    kernel = compiled()
    assert kernel(2, 5) == 15
    assert made == ["larger_tripled"]


def test_numba_is_left_as_it_was(made):
    compiled()
    made.clear()
    # Another's function, which calls what the kernel has brought into numba's caches.
    own = numba.njit("int64(int64, int64)")(lambda first, second: max(first, second) + 1)
    assert own(2, 5) == 6
    assert len(made) >= 1
    assert "_library_class" not in vars(whole_kernels._codegen())


def test_without_its_private_names_numba_compiles_as_ever(made, monkeypatch):
    monkeypatch.setattr(whole_kernels, "_OF_LIBRARY", ("_of_no_numba",))
    assert compiled()(2, 5) == 15
    assert len(made) >= 2


def test_wrappers_of_another_name_cost_time_and_no_code(monkeypatch):
    monkeypatch.setattr(whole_kernels, "_WRAPPER", "ZN6other")
    assert compiled()(2, 5) == 15
