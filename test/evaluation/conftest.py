import pytest
from evaluation_samples import make_evaluation


@pytest.fixture(scope="session")
def made_evaluation(tmp_path_factory):
    """An evaluation's folder that nobody writes to; the recordings stand beside it."""
    return make_evaluation(tmp_path_factory.mktemp("made"))
