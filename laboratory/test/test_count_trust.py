# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The fit of what a count is worth: its likelihood is that of the package's own distributions."""

import numpy as np
import pytest

from laboratory import count_trust
from laboratory.count_trust import Clip, Likelihood, fitted, packed, trust_of, unpacked
from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCount

LINES = [
    LineCount(3, 3, (3, 3), {Sign.SEEN: 2, Sign.VAGUE: 1}),
    LineCount(4, 2, (2, 3), {Sign.SEEN: 2, Sign.DOUBTED: 1, Sign.BROKEN: 2}),
    LineCount(0, 1, (0, 1), {Sign.VAGUE: 1, Sign.JOINED: 1}),
    LineCount(0, 0, (0, 0), {}),
]


def test_the_likelihood_is_that_of_the_distributions():
    numbers = count_trust._START + 0.1
    shares = Likelihood([Clip("a", "one", "good", LINES)]).shares(numbers)
    trust = trust_of(numbers)
    for line, share in zip(LINES, shares.tolist(), strict=True):
        first, likely = trust.distribution(line.signs)
        assert share == pytest.approx(likely[line.true - first], rel=1e-3)


def test_a_fit_finds_the_share_of_crossings_that_are_true():
    rng = np.random.default_rng(1)
    true = rng.binomial(20, 0.8, 200)
    lines = [LineCount(int(n), 20, (0, 0), {Sign.SEEN: 20}) for n in true]
    trust = fitted([Clip("a", "one", "good", lines)])
    mean = 20 * (trust.true[Sign.SEEN] + trust.missed[Sign.SEEN]) + trust.unseen
    assert mean == pytest.approx(true.mean(), abs=0.3)


def test_counts_are_kept_whole():
    assert [unpacked(packed(one)) for one in LINES] == LINES
