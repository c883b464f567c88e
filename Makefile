# Each command makes what it needs first: system libraries, then the environment .venv.
# PYTHON is the interpreter of the environment; ARGS goes to pytest: make test ARGS="-k furnace"
# It also names pictures: make pictures ARGS=drink
# SCENE is what `make view` shows: a scene file, a name of one in scenes/, or a picture.
PYTHON ?= python3
ARGS ?=
SCENE ?= cornell

BOOTSTRAP = "$(PYTHON)" tools/bootstrap.py
IN_ENVIRONMENT = .venv/bin/python -m
# A process a core; beyond 8, each would mostly wait for the one that has the longest test.
# Who has no test left takes from who has most: modules are torn apart at a few places alone.
IN_PROCESSES = -n auto --maxprocesses 8 --dist worksteal

.PHONY: help render view test check reference gallery pictures bench charts mutants clean

help: ## show this list
	@awk -F ':.*## ' '/^[a-z]+:.*## /{printf "make %-9s %s\n", $$1, $$2}' Makefile

render: ## render scenes/cornell.toml to cornell.png
	@$(BOOTSTRAP) render
	.venv/bin/glrt render cornell -o cornell.png

view: ## show scenes/cornell.toml in a window, or another one: make view SCENE=lamps
	@$(BOOTSTRAP) view
	.venv/bin/glrt view "$(SCENE)"

test: ## run the tests, without the slow ones
	@$(BOOTSTRAP) test
	$(IN_ENVIRONMENT) pytest -m "not slow" $(IN_PROCESSES) $(ARGS)

check: ## check the source: style, types, plain words
	@$(BOOTSTRAP) check
	$(IN_ENVIRONMENT) ruff check
	$(IN_ENVIRONMENT) ruff format --check
	$(IN_ENVIRONMENT) mypy
	.venv/bin/python tools/plain_words.py

reference: ## write the pages of docs/reference/ that follow from the program
	@$(BOOTSTRAP) render
	.venv/bin/python tools/reference.py

gallery: ## render every scene into gallery/
	@$(BOOTSTRAP) render
	$(IN_ENVIRONMENT) bench.gallery

pictures: ## write all pictures in docs/pictures/; takes an hour
	@$(BOOTSTRAP) bench
	$(IN_ENVIRONMENT) bench.pictures $(ARGS)

bench: ## measure how fast the kernel, its variants and the window are, and other renderers
	@$(BOOTSTRAP) bench
	$(IN_ENVIRONMENT) bench.window_tour drag
	$(IN_ENVIRONMENT) bench.drags
	$(IN_ENVIRONMENT) bench.kernels --seconds 0.1
	$(IN_ENVIRONMENT) bench.shape_counts
	$(IN_ENVIRONMENT) bench.memory
	$(IN_ENVIRONMENT) bench.roofline
	$(IN_ENVIRONMENT) bench.rivals
	$(IN_ENVIRONMENT) bench.efficiency

charts: ## measure error against time on fifteen scenes that separate the methods, into docs/results/chart/
	@$(BOOTSTRAP) test
	.venv/bin/glrt chart scenes/methods/*.toml -o docs/results/chart

mutants: ## plant classic bugs in the shaders, one at a time; the tests must find each
	@$(BOOTSTRAP) test
	$(IN_ENVIRONMENT) tests.mutation

clean: ## remove .venv and all caches; pictures stay
	rm -rf .venv build dist .pytest_cache .hypothesis .mypy_cache .ruff_cache
	find glrt bench tests tools -name __pycache__ -prune -exec rm -rf {} +
