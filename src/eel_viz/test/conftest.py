# SPDX-License-Identifier: Apache-2.0
"""Rerun raises on bad data instead of warning; recordings are made in a folder of the test's own."""

import pytest


@pytest.fixture(autouse=True, scope="session")
def strict_rerun():
    import rerun as rr

    rr.set_strict_mode(True)


@pytest.fixture
def record_made_up(tmp_path):
    """record_made_up(seconds, rate, **settings) -> (path, samples): the made-up swimmer, logged without ROS."""
    from made_up_recording import record

    def record_here(seconds: float = 1.0, rate: float = 100.0, **settings):
        path = tmp_path / "made_up.rrd"
        return path, record(path, seconds, rate, **settings)

    return record_here


@pytest.fixture(scope="session")
def can_draw(tmp_path_factory):
    """Skips with the reason where the viewer cannot draw."""
    from eel_viz.viewer import CannotRender, viewer

    try:
        with viewer((640, 360)) as client:
            client.take_screenshot()
    except CannotRender as reason:
        if "Vulkan" not in str(reason):
            raise
        pytest.skip(f"no picture: {reason}")


@pytest.fixture
def network(fresh_domain):
    """A node in this process, spun by hand."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=fresh_domain)
    node = rclpy.create_node("tester", context=context)
    node.executor_of_test = SingleThreadedExecutor(context=context)
    node.executor_of_test.add_node(node)
    yield node
    node.executor_of_test.shutdown()
    node.destroy_node()
    rclpy.try_shutdown(context=context)
