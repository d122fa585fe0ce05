# SPDX-License-Identifier: Apache-2.0
"""The table that the C++ tests of the mechanics compare with is what the reference writes."""

import re

import numpy as np
import pytest
from make_core_table import OUT, table

pytestmark = pytest.mark.skipif(not OUT.is_file(), reason="a package alone has no C++ sources")


def numbers_in(text: str) -> np.ndarray:
    return np.array([float(number) for number in re.findall(r"(?<![\w.])-?\d[\w.+-]*", text)])


def test_the_table_of_the_cpp_tests_is_what_the_reference_writes():
    kept, written = numbers_in(OUT.read_text()), numbers_in(table())
    assert len(kept) > 70
    np.testing.assert_allclose(kept, written, rtol=1e-6, atol=1e-6)
