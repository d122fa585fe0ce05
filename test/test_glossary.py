# SPDX-License-Identifier: Apache-2.0
"""The glossary has every private word of code and pages, and what it says is so."""

import re
from pathlib import Path
from typing import NamedTuple

import pytest
from eel_dynamics.accuracy.accuracy import PRESETS, STANDARD

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference" / "glossary.md"
# Words with a meaning of their own here, as readers find them. One that goes from the code goes from this list.
PRIVATE = (
    "accuracy", "adopt", "beat", "blend", "breakpoint", "closure", "companion", "demand", "delivered", "draft",
    "envelope", "evaluation", "fine", "gait", "imposed", "kink", "law", "ledger", "look", "march", "missed",
    "mode", "panel", "ramp", "reference", "resampling", "roundness", "row", "sample", "scene", "section",
    "sensitive", "settled", "slip", "snapshot", "standard", "station", "stop", "stride", "support", "swim",
    "term", "transition", "trim",
)  # fmt: skip
# Telegraphy, and words that have become others: never again in code or pages.
BANNED = (
    r"that there (is|are) not", r"\bfor who\b", r"(?i)\bwhoever\b", r"\bunvouched\b", r"\bvouches for\b",
    r"\bround alike\b", r"whatever calls", r"\bwhat (does|do) not fit\b", r"\bhas no word for\b",
)  # fmt: skip


class Entry(NamedTuple):
    word: str
    meaning: str
    name: str  # that defines it
    file: Path


def entries():
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \| `(\w+)` in \[[^\]]+\]\(([^)]+)\) \|$", PAGE.read_text(), re.MULTILINE)
    return [Entry(word, meaning, name, (PAGE.parent / file).resolve()) for word, meaning, name, file in rows]


def sources():
    files = [path for kind in ("*.py", "*.hpp", "*.cpp") for path in (ROOT / "src").glob(f"eel_*/**/{kind}")]
    return [path for path in files if not {"test", "build"} & set(path.relative_to(ROOT).parts)]


def pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]


@pytest.fixture(scope="module")
def texts():
    return {path: path.read_text(encoding="utf8") for path in [*sources(), *pages()] if path != PAGE}


def test_every_row_of_the_glossary_is_read_and_the_words_are_in_order():
    found = entries()
    assert len(found) == PAGE.read_text().count("\n| ") - 1  # without the head of the table
    assert [each.word for each in found] == sorted({each.word for each in found})


@pytest.mark.parametrize("entry", entries(), ids=lambda each: each.word)
def test_a_word_of_the_glossary_is_in_use_and_its_name_is_defined_where_it_says(entry, texts):
    definition = rf"\b(class|struct|def|enum) {entry.name}\b|^\s*(\w[\w:<>, ]* )?{entry.name}(: | ?=)"
    assert re.search(definition, entry.file.read_text(), re.MULTILINE), f"{entry.file} does not define {entry.name}"
    used = re.compile(rf"\b{entry.word.split()[0]}", re.IGNORECASE)
    assert sum(bool(used.search(text)) for text in texts.values()) > 1


@pytest.mark.parametrize("word", PRIVATE)
def test_a_private_word_that_is_in_use_is_explained(word, texts):
    used = re.compile(rf"\b{word}(s|ed|es)?\b", re.IGNORECASE)
    assert any(used.search(text) for text in texts.values()), "it has gone: take it off the list"
    assert any(used.search(each.word) or f"`{word}`" in each.meaning for each in entries())


def test_the_presets_are_those_of_the_code():
    (accuracy,) = (each for each in entries() if each.word == "accuracy")
    for name, target in PRESETS.items():
        default = " (default)" if name == STANDARD else ""
        assert f"`{name}` {target:.0e}".replace("e-0", "e-") + default in accuracy.meaning


@pytest.mark.parametrize("phrase", BANNED)
def test_a_banned_phrase_is_nowhere(phrase, texts):
    found = re.compile(phrase)
    assert [str(path.relative_to(ROOT)) for path, text in texts.items() if found.search(text)] == []
