# SPDX-License-Identifier: Apache-2.0
"""Who can reach what the visualiser serves: this machine alone, unless more is asked for."""

import signal
import urllib.request

import psutil
import pytest
from eel_viz.viewer import free_port, listening


def serve(start, tmp_path, *settings):
    """A visualiser that serves data and web viewer: (its process, the two ports)."""
    ports = free_port(), free_port()
    words = ["sink:=serve", f"port:={ports[0]}", f"web_port:={ports[1]}", *settings]
    node = start("visualiser", "--ros-args", *[word for setting in words for word in ("-p", setting)])
    node.wait_for_output("look at it in a browser")
    return node, ports


def addresses(ports) -> dict[int, set[str]]:
    """Where this machine listens on the ports."""
    found = {port: set() for port in ports}
    for connection in psutil.net_connections("tcp"):
        if connection.status == psutil.CONN_LISTEN and connection.laddr.port in found:
            found[connection.laddr.port].add(connection.laddr.ip)
    return found


@pytest.mark.fault(
    "neighbours",
    "somebody on the same network looks for served data or the web viewer",
    "not reached: both listen on 127.0.0.1, unless `address` says otherwise",
)
def test_served_data_and_web_viewer_are_for_this_machine_alone(start, tmp_path):
    node, ports = serve(start, tmp_path)
    assert addresses(ports) == {port: {"127.0.0.1"} for port in ports}
    with urllib.request.urlopen(f"http://127.0.0.1:{ports[1]}/", timeout=30) as page:
        assert b"Rerun" in page.read()
    assert "can read what is served" not in node.output()
    assert node.interrupt() == 0
    assert not any(listening(port) for port in ports), "something was left behind"


def test_every_network_if_asked_and_then_it_says_so(start, tmp_path):
    node, ports = serve(start, tmp_path, "address:=0.0.0.0")
    assert addresses(ports) == {port: {"0.0.0.0"} for port in ports}
    assert "can read what is served" in node.output() and "serving on 0.0.0.0" in node.output()
    assert node.interrupt() == 0


def test_a_killed_visualiser_leaves_no_web_viewer_behind(start_to_kill, tmp_path):
    node, ports = serve(start_to_kill, tmp_path)
    (child,) = psutil.Process(node.process.pid).children()
    node.interrupt(signal.SIGKILL)
    child.wait(timeout=60)
    assert not listening(ports[1])


def test_an_address_that_is_none_is_refused(start):
    node = start("visualiser", "--ros-args", "-p", "address:=everywhere")
    assert node.wait(90.0) == 2
    assert node.output().splitlines()[-1] == (
        "visualiser: address must be an IPv4 address such as 127.0.0.1, got 'everywhere'"
    )
