# make run: set up and generate the paper's models; make quick: what takes a minute; make test: everything that CI checks.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
PAPER := skate front_car front_car_wheelset rear_car rapkm_2rrr_rr rapkm_two_drives
# Given by energies: campaigns take these; those given by bodies are verified with more states by `make mechanisms`.
CAMPAIGN := $(PAPER) double_pendulum slider_crank
CAMPAIGN_FILES := $(CAMPAIGN:%=models/%.yaml)
MODELS := $(wildcard models/*.yaml)
MECHANISMS := $(filter-out $(CAMPAIGN_FILES),$(MODELS))

.PHONY: run quick lint test generated mechanisms fuzz proof campaigns campaigns-changed firmware bench bench-mechanisms bench-derivatives generation stress stress-derivatives skipping passes constants trig zoo zoo-case zoo-sweeps docs api site lock robots jax torch fmpy semidefinite study

run: $(VENV)/installed
	$(BIN)/symgen $(PAPER:%=models/%.yaml)

test: lint
	$(BIN)/pytest -n 2 --dist loadfile

# In the minute between two edits: all but tests of other packages, of several at once, and slow ones.
quick: lint
	$(BIN)/pytest -n 2 --dist loadfile --unit

lint: $(VENV)/installed
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/mypy tools
	$(BIN)/lint-imports

# Every model; git keeps four whole folders, and of the others the derivation and the checksums of their files.
generated: $(VENV)/installed
	$(BIN)/symgen models/*.yaml
	$(BIN)/python tools/generated_checksums.py generated $(MODELS:models/%.yaml=%)

# What takes minutes is recorded in tests/campaigns.json with a hash of what went in; see tools/campaigns.py.
RECORDED := $(BIN)/python tools/campaigns.py

# All that is recorded; and what has changed since then with a sample of the rest, which must give the same.
campaigns: robots study
	$(RECORDED) run

campaigns-changed: robots study
	$(RECORDED) changed $(shell git rev-list --count HEAD)

# Every mechanism given by bodies at more states than `make generated` takes, and the longer witnesses; minutes.
mechanisms: robots
	$(RECORDED) run mechanisms

# Run time against error of every model beside other tools: docs/bench, measured on this machine.
BENCHED := $(CAMPAIGN_FILES) docs/bench/rapkm_without_payload.yaml
bench: $(VENV)/installed
	$(RECORDED) run bench
	$(BIN)/python tools/bench_pages.py generated $(BENCHED)

# u of mechanisms given by bodies beside peers that walk their frames: docs/bench/mechanisms.md.
WALKED := front_car_bodies rapkm_bodies delta gough_stewart chain8 chain16 chain32 arm7
bench-mechanisms: $(VENV)/installed
	$(BIN)/symgen bench --bodies $(wildcard $(WALKED:%=models/%.yaml)) --quiet --out build/bench
	$(BIN)/python tools/mechanisms_page.py build/bench $(WALKED)

# Derivatives of u of both, beside CasADi's and Pinocchio's: docs/bench/derivatives.md.
SLOPED := $(filter-out chain32,$(WALKED))
bench-derivatives: $(VENV)/installed
	$(BIN)/symgen bench --derivatives $(BENCHED) $(wildcard $(SLOPED:%=models/%.yaml)) --quiet --out build/bench
	$(BIN)/python tools/derivatives_page.py build/bench $(notdir $(basename $(BENCHED))) $(SLOPED)

# CPU time and memory of cold starts, with their goals: docs/bench/generation.md, measured on this machine.
generation: $(VENV)/installed
	$(BIN)/python tools/generation_page.py

# The portable sine and cosine at every float32, a minute on two cores.
trig: $(VENV)/installed
	$(RECORDED) run trig

# Numerical stability of every model: docs/stress, measured on this machine.
stress: $(VENV)/installed
	$(RECORDED) run stress; status=$$?; \
	    $(BIN)/python tools/stress_pages.py generated $(CAMPAIGN_FILES) && exit $$status

# Derivatives of u beside those of the paper's formulas, where these fail: docs/stress/derivatives.md, in minutes.
stress-derivatives: $(VENV)/installed
	$(BIN)/python tools/stress_derivatives_page.py models/rapkm_2rrr_rr.yaml

# Every model on every emulated core, the goals of cost, the example firmware.
firmware: $(VENV)/installed
	$(RECORDED) run firmware

# Random systems through the whole command, each ending looked at: a chunk of a campaign, or as much as fits in a time.
# What fails is made small and is a test from then on.
ZOO_SEED ?= $(shell git rev-list --count HEAD)
ZOO_FIRST ?= 0
ZOO_DRAWS ?= 1000
ZOO_SECONDS ?= 0
zoo: $(VENV)/installed
	$(BIN)/python -m symgen.laboratory.zoo --seed $(ZOO_SEED) --first $(ZOO_FIRST) --draws $(ZOO_DRAWS) --seconds $(ZOO_SECONDS) \
	    --out build/zoo --cases tests/zoo/cases

# The same of one draw, under a name: make zoo-case ZOO_SEED=3 ZOO_FIRST=14 CASE=name
zoo-case: $(VENV)/installed
	$(BIN)/python -m symgen.laboratory.zoo --seed $(ZOO_SEED) --first $(ZOO_FIRST) --store tests/zoo/cases/$(CASE).yaml --out build/zoo

# The rule of statuses on random systems: led towards their singular sets, masses and lengths up to 1e9 apart.
zoo-sweeps: $(VENV)/installed
	$(BIN)/python -m symgen.laboratory.zoo --sweeps --seed $(ZOO_SEED) --first $(ZOO_FIRST) --draws $(ZOO_DRAWS) \
	    --seconds $(ZOO_SECONDS) --out build/zoo-sweeps

# What each part of the structure analysis is worth in operations: docs/skipping.md.
skipping: $(VENV)/installed
	$(BIN)/python tools/skipping_page.py $(CAMPAIGN_FILES) $(MECHANISMS)

# What each rewriting pass is worth in operations, with models drawn for it too: docs/passes.md.
passes: $(VENV)/installed
	$(BIN)/python tools/passes_page.py $(MODELS)

# What half and twice of each tuned constant changes: docs/constants.md, half an hour.
constants: $(VENV)/installed
	nice $(BIN)/python tools/constants_page.py $(MODELS)

# Every kernel of every model under libFuzzer and the sanitizers, a minute each: raw bits in, see proof/*_fuzz.c.
FUZZ_SECONDS ?= 60
fuzz: $(VENV)/installed
	$(BIN)/symgen $(MODELS) --only c,proof --recorded generated --out build/fuzz > /dev/null
	$(BIN)/python tools/fuzz_campaign.py build/fuzz $(FUZZ_SECONDS) $(CAMPAIGN) --sums $(MECHANISMS:models/%.yaml=%)

# u in float32 under Frama-C Eva and Gappa, every model: a table of what is proved, what was measured, what remains.
proof: $(VENV)/installed
	$(RECORDED) run proof; status=$$?; cat build/campaigns/proof-*.log; exit $$status

# The marked blocks of README.md and the generated pages of docs/, with times measured on this machine.
docs: $(VENV)/installed
	$(BIN)/python tools/fill_readme.py
	$(BIN)/python tools/notebook_page.py

# Every public name of the package with its docstring, as HTML: open build/api/symgen.html.
api: $(VENV)/installed
	$(BIN)/python tools/api_reference.py build/api

# The pages of the documentation as a site: open build/site/html/index.html.
site: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --requirement docs/site.lock
	$(BIN)/python tools/site_pages.py

# One lock for every platform and Python from 3.11 on; editables is what the build backend needs for `pip install -e`.
lock: $(VENV)/installed
	$(BIN)/pip install --quiet uv
	printf 'editables\nhatchling\n' | $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
	    --no-header --no-annotate --no-emit-index-url --no-emit-find-links --extra test \
	    --output-file requirements.lock pyproject.toml -
	printf 'pin\nexample-robot-data\nmujoco\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 \
	    --python-platform x86_64-manylinux_2_28 --generate-hashes --constraint requirements.lock --no-header \
	    --no-annotate --no-emit-index-url --no-emit-find-links --output-file tests/mechanisms/robots.lock -
	printf 'jax\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 --python-platform x86_64-manylinux_2_28 \
	    --generate-hashes --constraint requirements.lock --no-emit-package numpy --no-emit-package scipy --no-header \
	    --no-annotate --no-emit-index-url --no-emit-find-links --output-file tests/backends/jax.lock -
	printf 'torch\narray-api-compat\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 \
	    --python-platform x86_64-manylinux_2_28 --generate-hashes --constraint requirements.lock --no-emit-package numpy \
	    --no-emit-package jinja2 --no-emit-package markupsafe --no-emit-package sympy --no-emit-package mpmath \
	    --no-emit-package setuptools --no-header --no-annotate --no-emit-index-url --no-emit-find-links \
	    --output-file tests/backends/torch.lock -
	printf 'fmpy\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 --python-platform x86_64-manylinux_2_28 \
	    --generate-hashes --constraint requirements.lock --no-emit-package numpy --no-header --no-annotate \
	    --no-emit-index-url --no-emit-find-links --output-file tests/backends/fmpy.lock -
	printf 'dask[distributed]\nxarray\nzarr\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 \
	    --python-platform x86_64-manylinux_2_28 --generate-hashes --constraint requirements.lock --no-header \
	    --no-annotate --no-emit-index-url --no-emit-find-links --output-file tests/study/study.lock -
	printf 'clarabel\ncvxpy-base\n' | $(BIN)/uv pip compile --quiet --python-version 3.11 \
	    --python-platform x86_64-manylinux_2_28 --generate-hashes --constraint requirements.lock --no-header \
	    --no-annotate --no-emit-index-url --no-emit-find-links --output-file tests/identification/semidefinite.lock -
	printf 'mkdocs-material\nmkdocstrings[python]\n' | $(BIN)/uv pip compile --quiet --universal --python-version 3.11 \
	    --generate-hashes --constraint requirements.lock --no-header --no-annotate --no-emit-index-url \
	    --no-emit-find-links --output-file docs/site.lock -

# Pinocchio, MuJoCo and published robot descriptions, witnesses of the mechanisms: wheels for Linux and Python 3.11.
robots: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --requirement tests/mechanisms/robots.lock

# Dask, xarray and Zarr, on which studies run.
study: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --requirement tests/study/study.lock

# CVXPY and Clarabel, by which `symgen identify` finds bodies that can be: a witness of the way without them.
semidefinite: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --requirement tests/identification/semidefinite.lock

# JAX, under which docs/array-api.md runs: beside the environment, so that nothing else meets it.
jax: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --no-deps --upgrade --target build/jax --requirement tests/backends/jax.lock

# PyTorch for the same page: 5 GB, which its check is skipped without.
torch: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --no-deps --upgrade --target build/torch \
	    --requirement tests/backends/torch.lock

# FMPy, which runs units of FMI: beside the environment as well.
fmpy: $(VENV)/installed
	$(BIN)/pip install --quiet --require-hashes --no-deps --upgrade --target build/fmpy --requirement tests/backends/fmpy.lock

$(VENV)/locked: requirements.lock
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --require-hashes --requirement requirements.lock
	touch $@

$(VENV)/installed: $(VENV)/locked pyproject.toml
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	$(BIN)/python -m compileall -q symgen
	touch $@
