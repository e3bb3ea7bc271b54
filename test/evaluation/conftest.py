# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
