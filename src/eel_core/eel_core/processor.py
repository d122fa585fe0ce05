# SPDX-License-Identifier: Apache-2.0
"""What this machine's processor can do: its x86-64 level (x86-64 psABI, table of micro-architecture levels).

As a script it prints the level, for the build.
"""

import platform
from pathlib import Path

CPUINFO = Path("/proc/cpuinfo")

# Level: what it has above the level before, in the words of /proc/cpuinfo (pni is SSE3, abm has LZCNT).
FEATURES = {
    "v2": {"cx16", "lahf_lm", "popcnt", "pni", "ssse3", "sse4_1", "sse4_2"},
    "v3": {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"},
    "v4": {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
}


TOO_OLD = (
    "eel_core needs a processor of level x86-64-v2 or above, and this one lacks {}: take a machine from 2009 or later, "
    "or a virtual machine whose processor is not reduced (qemu: -cpu host)"
)


def is_x86_64() -> bool:
    return platform.machine() in ("x86_64", "AMD64")


def features() -> frozenset[str]:
    """What the processor can do and the system lets programs use; empty where /proc/cpuinfo does not tell."""
    try:
        lines = CPUINFO.read_text().splitlines()
    except OSError:
        return frozenset()
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() == "flags":
            return frozenset(value.split())
    return frozenset()


def lacking(found: frozenset[str]) -> list[str]:
    """What a processor with the features `found` lacks of the lowest level, which everything here needs."""
    return sorted(FEATURES["v2"] - found) if found else []


def levels(found: frozenset[str]) -> list[str]:
    """The x86-64 levels of a processor with the features `found`, highest first. v2 where nothing is known."""
    if not found:
        return ["v2"]
    reached: list[str] = []
    for level, needed in FEATURES.items():
        if not needed <= found:
            break
        reached.insert(0, level)
    return reached


if __name__ == "__main__":
    here = features()
    if lacking(here):
        raise SystemExit(TOO_OLD.format(", ".join(lacking(here))))
    print(levels(here)[0])
