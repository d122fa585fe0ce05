"""The physics side of the package imports without any ROS."""

import subprocess
import sys

WITHOUT_ROS = """
import importlib, pkgutil, sys
for name in ("rclpy", "eel_msgs", "std_msgs", "builtin_interfaces", "rcl_interfaces", "scipy"):
    sys.modules[name] = None   # an import of it raises ImportError
import eel_gaits
names = {module.name for module in pkgutil.iter_modules(eel_gaits.__path__)}
for name in sorted(names - {"node", "messages"}):
    importlib.import_module(f"eel_gaits.{name}")
assert {"law", "gaits", "spline", "settings"} <= names, names
assert eel_gaits.gait("falling").curvature(1.0, [0.0, 1.0])[0].shape == (2, 3)
print("imported", len(names) - 2)
"""


def test_everything_but_the_node_and_its_messages_imports_without_ros():
    ended = subprocess.run([sys.executable, "-c", WITHOUT_ROS], capture_output=True, text=True, timeout=60, check=False)
    assert ended.returncode == 0, ended.stderr
    assert int(ended.stdout.split()[1]) >= 5
