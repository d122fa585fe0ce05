# SPDX-License-Identifier: Apache-2.0
"""Options, parameters, defaults, units, bounds and topics change only by intention."""

from interface import FILE, lines


def test_what_users_can_give_and_get_is_as_interface_txt_has_it():
    kept, found = FILE.read_text(encoding="utf-8").splitlines(), list(lines())
    apart = [f"- {line}" for line in kept if line not in found] + [f"+ {line}" for line in found if line not in kept]
    assert kept == found, "run `tools/run.sh python test/interface.py` if this is meant:\n" + "\n".join(apart)
