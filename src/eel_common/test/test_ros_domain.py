# SPDX-License-Identifier: Apache-2.0
"""The ROS domains that tests and the demo run in."""

from eel_common.ros.testing.ros_domain import PORT_BASE, PORTS_PER_DOMAIN, forget_the_killed, reserve_domain


def test_what_killed_processes_have_left_is_removed_and_nothing_else(tmp_path):
    port, end = PORT_BASE + PORTS_PER_DOMAIN * 62, PORT_BASE + PORTS_PER_DOMAIN * 63
    stale = [f"fastrtps_port{port}", f"fastrtps_port{port + 13}_el", f"sem.fastrtps_port{end - 1}_mutex"]
    others = [f"fastrtps_port{port - 1}", f"sem.fastrtps_port{end}_mutex", "fastrtps_0123456789abcdef", "ports"]
    for name in stale + others:
        (tmp_path / name).touch()
    forget_the_killed(62, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(others)


def test_a_domain_is_claimed_until_it_is_let_go():
    first = reserve_domain()
    others = [reserve_domain() for _ in range(3)]
    assert len({first.number, *(domain.number for domain in others)}) == 4
    assert first.environment()["ROS_DOMAIN_ID"] == str(first.number)
    for domain in [first, *others]:
        domain.claim.close()
