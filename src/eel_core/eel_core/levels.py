# SPDX-License-Identifier: Apache-2.0
"""Chooses the compiled module that suits this processor, before anything compiled is imported."""

import os
from collections.abc import Collection
from importlib import import_module
from types import ModuleType

from eel_core import processor
from eel_core.built import LEVELS, NATIVE_FEATURES

CHOICE = "EEL_CORE_LEVEL"  # environment variable: one level instead of the highest, to compare them


def suitable_levels(built: Collection[str], features: frozenset[str], native_features: frozenset[str]) -> list[str]:
    """Those of the levels `built` that a processor with `features` runs, best first.

    native_features: those of the processor that "native" was built on.
    """
    candidates = processor.levels(features)
    if native_features and native_features <= features:
        candidates = ["native", *candidates]
    return [level for level in candidates if level in built]


def import_built(name: str) -> ModuleType:
    """A compiled module that the build has listed."""
    try:
        return import_module(f"eel_core.{name}")
    except ImportError as error:
        raise ImportError(f"eel_core.{name} is missing or damaged ({error}): build eel_core again") from error


def import_core() -> ModuleType:
    """The compiled module for this processor. ImportError in one line where there is none."""
    if not processor.is_x86_64():
        if LEVELS:
            raise ImportError(f"eel_core was built for x86-64, this processor is {os.uname().machine}: build it here")
        return import_built("_core")
    features = processor.features()
    if lacking := processor.lacking(features):
        raise ImportError(processor.TOO_OLD.format(", ".join(lacking)))
    suitable = suitable_levels(LEVELS, features, NATIVE_FEATURES)
    if not suitable:
        raise ImportError(
            f"eel_core was built for {', '.join(LEVELS) or 'another processor than x86-64'}, this processor is "
            f"x86-64 {processor.levels(features)[0]}: build it here, or for several levels with "
            '-DEEL_CORE_LEVELS="v2;v3;v4"'
        )
    wanted = os.environ.get(CHOICE)
    if wanted and wanted not in suitable:
        raise ImportError(f"{CHOICE} must be one of {', '.join(suitable)} here, got {wanted!r}")
    return import_built(f"_core_{wanted or suitable[0]}")
