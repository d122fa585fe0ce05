# SPDX-License-Identifier: Apache-2.0
"""Checks the metadata.yaml of a bag before rosbags reads it, whose parser has no bounds."""

import pathlib
from typing import Any

from eel_base.files.input_file import InputFile, reading
from eel_base.files.yaml_tree import MOST_BYTES, from_yaml, read_yaml

NAME = "metadata.yaml"
MOST_VALUES = 10_000  # a publisher takes 20, a file 10


def check_metadata(folder: pathlib.Path) -> None:
    """`ValueError` where metadata.yaml has too much, or names what is no regular file in the folder."""
    with reading(NAME):
        tree = read_yaml(folder / NAME)
        about = tree["rosbag2_bagfile_information"]
        profiles = [topic["topic_metadata"].get("offered_qos_profiles") for topic in about["topics_with_message_count"]]
        texts = [each for each in profiles if isinstance(each, str)]  # of YAML, before ROS 2 Jazzy
        if (size := sum(map(len, texts))) > MOST_BYTES:
            raise ValueError(f"its profiles must have at most {MOST_BYTES} characters, got {size}")
        left = MOST_VALUES - _count(tree)
        for text in texts:
            left -= _count(from_yaml(text, left))
        if left < 0:
            raise ValueError(f"it must have at most {MOST_VALUES} values")
        names = [pathlib.PurePath(name).name for name in about["relative_file_paths"]]
        if len(set(names)) < len(names) or not isinstance(about.get("files", []), list):
            raise ValueError("it must list files, each with a name of its own")
        for name in names:
            InputFile(folder / name).close()


def _count(tree: Any) -> int:
    """The number of values in a tree of mappings and lists."""
    inner = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    return 1 + sum(map(_count, inner))
