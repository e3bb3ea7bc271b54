# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.core import products
from vehicle_pf_tracker.core.products import product


def test_product_of_small_matrices_by_hand():
    left, right = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[5.0], [6.0]])
    assert product(left, right).tolist() == [[17.0], [39.0]]


@settings(max_examples=50)
@given(
    rows=st.integers(1, 90), inner=st.integers(0, 40), columns=st.integers(1, 90),
    serial=st.integers(1, 5000), stacks=st.sampled_from([((), ()), ((3,), ()), ((), (3,))]),
)  # fmt: skip
def test_pieces_make_the_whole(rows, inner, columns, serial, stacks):
    rng = np.random.default_rng(rows * 91 + columns)
    left = rng.normal(size=(*stacks[0], rows, inner))
    right = rng.normal(size=(*stacks[1], inner, columns))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(products, "SERIAL", serial)
        assert product(left, right) == pytest.approx(left @ right, abs=1e-12)


@pytest.mark.parametrize(("rows", "columns"), [(40, 3000), (3000, 40)])
def test_no_piece_is_large_enough_for_a_second_thread(rows, columns, monkeypatch):
    pieces = []

    def noted(left, right):
        pieces.append(left.shape[0] * left.shape[1] * right.shape[1])
        return left @ right

    monkeypatch.setattr(np, "matmul", noted)
    left, right = np.ones((rows, 30), np.float32), np.ones((30, columns), np.float32)
    assert (product(left, right) == 30).all()
    assert len(pieces) > 1
    assert max(pieces) <= 1 << 18


def test_kind_of_the_numbers_is_kept():
    left, right = np.ones((40, 300), np.float32), np.ones((300, 400), np.float32)
    assert product(left, right).dtype == np.float32
