# `make demo` and `make test` need Python 3.10 to 3.13 with venv, and nothing else.
# Everything is installed into .venv, at the versions that requirements/*.txt lock.

PYTHON =
NOBLE_PYTHON =
PYTEST_ARGS =
BENCH_ARGS =
# File of a network, for `make detector`.
MODEL =
FIGURES = all
# Options of tools.release_check.
RELEASE_ARGS =
# Where `bench` and `reproduce` write their pages.
PAGES = docs
# How many targets `test-all` runs side by side, and which others than its parts.
JOBS = 2
BESIDE =

BIN := .venv/bin
INSTALL := -m pip install --quiet --disable-pip-version-check --no-deps
# What the versions of NumPy and OpenCV decide: numbers, pixels and messages.
VERSIONED := $(addprefix test/,filtering image trackers recordings scenes/test_first_scenes_stay.py \
	ros/test_conversions.py ros/node/test_node_images.py ros/node/test_node_encodings.py)
# Lifecycle, parameters, targets, processes and a replay: what a release of rclpy may change.
KILTED := $(addprefix test/ros/,test_rclpy_internals.py test_transport.py node/test_node_lifecycle.py \
	node/test_several_nodes.py node/test_node_requests.py replay/test_replay_lockstep.py)
# What each part of the tests but test-rest runs, which has the rest.
test-ros := ros
test-trackers := trackers
test-footage := scenes recordings
test-programs := test_programs.py
# Folders beside the package have their tests beside themselves: a change of the package does not wait for them.
RESEARCH := $(addsuffix /test,reproduction laboratory benchmarks)
# Share of the package's branches and lines that the tests must run through.
COVERED := 92

# The tests start hundreds of processes, and each would compile the package anew (0.3 s).
unexport PYTHONDONTWRITEBYTECODE

# ROS stays on this machine.
export ROS_AUTOMATIC_DISCOVERY_RANGE ?= LOCALHOST

# Each target that says of itself what it does, with two hashes, is listed by `make help`.
.PHONY: help demo test test-all covered test-research mutants test-rest test-trackers test-footage test-programs test-ros test-noble test-kilted kernels lint types format config colcon baselines bench reproduce docs detector dist release-check clean

demo: .venv/installed  ## run the whole chain on a synthetic scene, into results/demo
	$(BIN)/vehicle-pf-tracker demo -o results/demo --overwrite

help:  ## list the targets
	@sed -n 's/^\([a-z-]*\):.*  ## \(.*\)/\1|\2/p' $(firstword $(MAKEFILE_LIST)) | \
		while IFS='|' read -r target words; do printf '%-12s %s\n' "$$target" "$$words"; done

# Three parts side by side on two cores: the tests through ROS mostly wait, and the others compute. The longest
# begin first.
PARTS := test-ros test-rest test-trackers test-footage
RUN = $(BIN)/python -m pytest -m "not slow"
# What computes leaves the cores to the nodes of tests beside it, which have to answer in time.
CALMLY := nice

ifdef PYTEST_ARGS
test: .venv/installed
	$(RUN) $(PYTEST_ARGS)
else
# What takes a few seconds or less, without coverage. On cores that three parts share, threads of OpenCV's
# would spin for each other; test_thread_counts.py sets its own numbers, and test-all takes the machine's.
test: .venv/installed kernels  ## the fast tests, or PYTEST_ARGS="test/core …"
	OPENCV_FOR_THREADS_NUM=1 $(MAKE) --no-print-directory --jobs=3 --keep-going $(PARTS)
endif

# Everything, with branch coverage; the slow tests try every way to install, colcon's too.
test-all: .venv/installed .venv/colcon kernels  ## every test of the package, with branch coverage
	$(BIN)/coverage erase
	$(MAKE) --no-print-directory --jobs=$(JOBS) --keep-going covered $(BESIDE)

covered: RUN = $(BIN)/coverage run -m pytest
covered: $(PARTS) test-programs
	$(BIN)/coverage combine --quiet
	$(BIN)/coverage report --fail-under=$(COVERED)

# Compiled once, before the parts would each do it.
kernels: .venv/installed
	$(BIN)/python -c "from vehicle_pf_tracker.image.kernels.interface import compile_all; compile_all('auto')"

test-rest: .venv/installed
	$(CALMLY) $(RUN) test $(addprefix --ignore test/,$(test-ros) $(test-trackers) $(test-footage) $(test-programs))

test-trackers test-footage test-programs: MANNER := $(CALMLY)
# Shown when they have ended, so that the parts do not mix.
test-ros test-trackers test-footage test-programs: .venv/installed
	@log=$$(mktemp); $(MANNER) $(RUN) $(addprefix test/,$($@)) > $$log 2>&1; \
	status=$$?; cat $$log; rm -f $$log; exit $$status

test-research: .venv/installed kernels  ## tests of reproduction, laboratory and benchmarks, slow ones too
	$(CALMLY) $(BIN)/python -m pytest $(or $(PYTEST_ARGS),$(RESEARCH))

# Hours for a room of trackers, and a fifth of that with ROOMS="papers --sample 37"; the toy is one module,
# so that the target is known to work.
mutants: .venv/mutants  ## mutation testing of ROOMS=toy, filtering, road, counting or papers
	$(CALMLY) $(BIN)/python -m tools.mutants $(or $(ROOMS),toy)

test-noble: .venv-noble/installed  ## numbers, pixels and messages with the NumPy and OpenCV of Ubuntu 24.04
	$(CALMLY) .venv-noble/bin/python -m pytest -m "not slow" $(PYTEST_ARGS) $(VERSIONED)

test-kilted: .venv-kilted/installed  ## some tests of the nodes with the ROS 2 after Jazzy
	.venv-kilted/bin/python -m pytest -m "not slow" $(KILTED)

colcon: .venv/colcon  ## colcon build and its tests, in a scratch folder
	PATH="$(CURDIR)/$(BIN):$$PATH" .ci/colcon

# Trackers to compare with, and TrackEval: two OpenCV packages in one environment overwrite each other.
baselines: .venv-baselines/locked  ## build the environment of what is compared with

# Writes results/bench/bench.json and docs/performance.md, and with SEQUENCES=FOLDER the cost of fusion on
# them, results/fusion_cost; wants a machine with nothing else to do. With BENCH_ARGS=--toy some cases of
# every part run once, in less than a minute, and results/bench_toy has all that is written.
bench: .venv/installed .venv-baselines/locked  ## measure speed, memory and the node; writes docs/performance.md
	$(if $(SEQUENCES),$(BIN)/python -m benchmarks.fusion_cost $(SEQUENCES) --resampled car_a silver_estate S1301 -o results/fusion_cost)
	$(BIN)/python -m benchmarks.bench --docs $(PAGES) $(BENCH_ARGS)

# The papers' experiments; what was run before is not run again.
reproduce: .venv/installed  ## run the papers' experiments; writes docs/reproduction.md
	$(BIN)/python -m reproduction $(FIGURES) --docs $(PAGES)

lint: .venv/installed  ## ruff
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

format: .venv/installed  ## ruff format
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

types: .venv/installed  ## mypy
	$(BIN)/mypy

# Everything that follows from the registry of variants and their parameters.
config: .venv/installed  ## write what follows from the parameters: config/, tables in pages
	$(BIN)/python -m tools.generate

docs: .venv/docs  ## build the site of the pages, into results/site
	NO_MKDOCS_2_WARNING=true $(BIN)/python -m mkdocs build --quiet --strict

detector: .venv/installed  ## build the wheel vehicle-pf-detector of a network, MODEL=yolox_nano.onnx
	$(BIN)/python -m tools.detector_wheel $(MODEL) -o results/dist

dist: .venv/docs  ## build the wheel and the source archive, into results/dist
	rm -rf results/dist
	$(BIN)/python -m build --no-isolation --outdir results/dist . > /dev/null
	$(BIN)/twine check --strict results/dist/*
	cd results/dist && tar -xzf *.tar.gz && cd */ && \
		PYTHONPATH=. $(CURDIR)/$(BIN)/python -m pytest -m "not slow" test/core test/packaging test/tools test/test_walls.py

# Archives in fresh environments with RELEASE_ARGS="--extras video ros evaluation", the default, take minutes.
release-check: dist  ## all that has to hold before a release is tagged: checkout, archives, README
	$(BIN)/python -m tools.release_check results/dist $(RELEASE_ARGS)

clean:  ## remove what the other targets made
	rm -rf .venv .venv-noble .venv-kilted .venv-baselines build install log results *.egg-info
	rm -rf .coverage .coverage.* .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# A changed lock makes the environment anew; a changed description only installs the package again.

.venv/locked: requirements/locked.txt requirements/ros-jazzy.txt
	.ci/make-venv .venv requirements/locked.txt $(PYTHON)

.venv-noble/locked: requirements/noble.txt requirements/ros-jazzy.txt
	.ci/make-venv .venv-noble requirements/noble.txt $(or $(NOBLE_PYTHON),3.12 3.11 3.10)

.venv-kilted/locked: requirements/noble.txt requirements/ros-kilted.txt
	ROS_LOCK=requirements/ros-kilted.txt .ci/make-venv .venv-kilted requirements/noble.txt $(or $(NOBLE_PYTHON),3.12 3.11 3.10)

.venv-baselines/locked: vehicle_pf_tracker/evaluation/baselines.txt
	.ci/make-venv --without-ros .venv-baselines vehicle_pf_tracker/evaluation/baselines.txt $(PYTHON)

.venv/installed .venv-noble/installed .venv-kilted/installed: %/installed: %/locked setup.py setup.cfg pyproject.toml package.xml \
		vehicle_pf_tracker/trackers/registry.py
	$*/bin/python $(INSTALL) --no-build-isolation --editable .
	touch $@

.venv/colcon .venv/docs .venv/mutants: .venv/%: .venv/installed requirements/%.txt
	$(BIN)/python $(INSTALL) --requirement requirements/$*.txt
	touch $@
