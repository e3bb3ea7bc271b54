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

"""Environment of commands that coverage does not follow: ended by a signal, or long."""

import os


def unmeasured_environment():
    """Return the environment without what starts coverage in a child process.

    A signal handler that raises may do so while coverage's tracer holds its lock, which the
    child then waits for at its end, for ever.
    """
    return {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
