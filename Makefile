# SPDX-License-Identifier: Apache-2.0
# The two commands are `make demo` and `make test`; each does all the set-up itself, inside this folder.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: docs notebook quotes pictures help demo test sanitize aarch64 validation build bench lint soak robustness clean manoeuvres pilot
RUN := tools/run.sh

help:   ## this list
	@sed -n 's/^\([a-z0-9]*\):[^#]*## */make \1\t/p' Makefile | expand -t 17

demo: build   ## swim the falling gait through the three nodes; leaves out/falling.rrd and a summary
	@$(RUN) python tools/demo.py

test: build   ## all tests but the long ones (ARGS=... goes to pytest)
	@$(RUN) tools/test.sh $(ARGS)

sanitize: build   ## the mechanics under AddressSanitizer and UndefinedBehaviorSanitizer, and ThreadSanitizer
	@$(RUN) tools/core_tests.sh threads
	@$(RUN) tools/core_tests.sh sanitize

aarch64: build   ## the C++ tests of the mechanics compiled for 64-bit ARM, run by qemu
	@$(RUN) tools/core_tests.sh aarch64

validation: build   ## docs/appendix/validation.csv and its page anew, from what the tests of the mechanics measure
	@$(RUN) python src/eel_dynamics/test/validation.py

soak: build   ## the long tests (ARGS=... goes to pytest)
	@$(RUN) python -m pytest -m soak $(ARGS)

bench: build   ## speed and accuracy figures (ARGS=NAME for one of them)
	@$(RUN) python benchmarks/run.py $(ARGS)

docs: build   ## the site of docs/ in out/docs, links checked
	@$(RUN) tools/pages/docs.sh

notebook: build   ## run docs/tutorials/swim.ipynb anew, with its outputs in out/notebook
	@$(RUN) tools/pages/docs.sh notebook

pictures: build   ## draw the pictures of the tutorials and of the visualiser in docs/images
	@$(RUN) python tools/pages/tutorial_pictures.py
	@$(RUN) python tools/pages/pictures.py

manoeuvres: build   ## swim every gait, and write docs/reference/manoeuvres.md with its pictures
	@$(RUN) python tools/pages/manoeuvres.py

pilot: build   ## swim random courses with the pilot, and write the figures of docs/howto/pilot.md (ARGS="--courses 10")
	@$(RUN) python tools/pages/pilot_figures.py $(ARGS)

robustness: build   ## list every fault, and the test that shows what happens, in out/robustness.md
	@$(RUN) python tools/pages/fault_table.py

quotes: build   ## write the figures that README.md and docs quote, from the newest reports
	@$(RUN) python tools/quoted_figures.py

lint: build   ## rules, format, imports, spelling and quoted figures, Python and C++
	@$(RUN) tools/lint.sh

build:   ## the virtual environment and the packages (PYTHON=... chooses the Python)
	@PYTHON="$(PYTHON)" tools/build.sh

clean:   ## remove what build made; out/ stays
	rm -rf .venv .venv-peers build install log
