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

from vehicle_pf_tracker.cli.main import main


def test_a_folder_that_holds_no_evaluation(tmp_path, capsys):
    assert main(["report", str(tmp_path)]) == 1
    assert "is not an evaluation folder: it has no evaluation.json" in capsys.readouterr().err


def test_the_verb_writes_where_the_evaluation_is(tmp_path, capsys):
    (tmp_path / "evaluation.json").write_text('{"recordings": [], "systems": [], "seeds": []}')
    assert main(["report", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"the report is {tmp_path / 'report.html'}\n"
    assert (tmp_path / "report.html").stat().st_size > 1000
