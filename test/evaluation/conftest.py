# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import shutil

import pytest
from evaluation_samples import make_evaluation


@pytest.fixture(scope="session")
def made_evaluation(tmp_path_factory):
    """An evaluation's folder that nobody writes to; the recordings stand beside it."""
    return make_evaluation(tmp_path_factory.mktemp("made"))


@pytest.fixture
def evaluation_copy(made_evaluation, tmp_path):
    """A copy of the evaluation that may be written to."""
    return shutil.copytree(made_evaluation, tmp_path / "evaluation")
