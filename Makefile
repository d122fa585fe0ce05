# SPDX-License-Identifier: Apache-2.0
# The two commands are `make demo` and `make test`; each does all the set-up itself, inside this folder.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: docs wheels alone notebook evidence pictures help demo test sanitize aarch64 validation build bench lint soak robustness clean
RUN := tools/run.sh

help:   ## this list
	@sed -n 's/^\([a-z0-9]*\):[^#]*## */make \1\t/p' Makefile | expand -t 17

demo: build   ## swim the falling gait through the three nodes; leaves out/falling.rrd and a summary
	@$(RUN) python tools/demo.py

test: build   ## all tests but the long ones (ARGS=... goes to pytest)
	@$(RUN) tools/test.sh $(ARGS)

sanitize: build   ## the mechanics under AddressSanitizer and UndefinedBehaviorSanitizer, and ThreadSanitizer
	@$(RUN) tools/core_tests.sh sanitizers

aarch64: build   ## the C++ tests of the mechanics compiled for 64-bit ARM, run by qemu
	@$(RUN) tools/core_tests.sh aarch64

validation: build   ## docs/appendix/validation.csv and its page anew, from what the tests of the mechanics measure
	@$(RUN) python src/eel_dynamics/test/validation.py

soak: build   ## the long tests (ARGS=... goes to pytest)
	@$(RUN) python -m pytest -m soak $(ARGS)

bench: build   ## speed and accuracy figures (ARGS=NAME for one of them)
	@$(RUN) python benchmarks/run.py $(ARGS)

docs: build   ## the site of docs/ in out/docs with its gallery, links checked
	@$(RUN) tools/docs.sh

wheels: build   ## wheels of the library without ROS, in out/wheels (ARGS=test also installs them on a bare machine)
	@$(RUN) tools/wheels/build.sh $(ARGS)

alone: build   ## each package built and tested with those it depends on alone (ARGS=NAME for some), in out/alone
	@tools/each_package.sh $(ARGS)

notebook: build   ## run docs/tutorials/swim.ipynb anew, with its outputs in out/notebook
	@$(RUN) tools/docs.sh notebook

evidence: build   ## write the pages, tables and pictures of docs that the scripts in evidence make (ARGS=NAME for some)
	@$(RUN) python evidence/everything.py $(ARGS)

pictures: build   ## draw the films and pictures of docs anew, those of the gallery too (needs a Vulkan driver)
	@$(RUN) python evidence/everything.py pictures manoeuvres tutorial_pictures
	@$(RUN) python tools/gallery.py pictures $(ARGS)

robustness: build   ## list every fault, and the test that shows what happens, in out/robustness.md
	@$(RUN) python evidence/fault_table.py

lint: build   ## rules, format, imports and spelling, Python and C++
	@$(RUN) tools/lint.sh

build:   ## the virtual environment and the packages (PYTHON=... chooses the Python)
	@PYTHON="$(PYTHON)" tools/build.sh

clean:   ## remove what build made; out/ stays
	rm -rf .venv .venv-peers build install log
