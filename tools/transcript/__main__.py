# SPDX-License-Identifier: Apache-2.0
"""A user of ROS 2 at the nodes: runs the commands of each section, and writes docs/appendix/transcript.md.

`make transcript` (`ARGS="2 6"`: these sections alone, printed and not written).
"""

import shutil
import sys
import tempfile
from pathlib import Path

from sections import SECTIONS, frames_and_tools
from shell import Shell

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE, PICTURE = DOCS / "appendix" / "transcript.md", DOCS / "images" / "markers.png"
HEAD = """# A transcript of the nodes

Made by: `make transcript`, which runs these commands and writes this page. Run it again and compare. The nodes are
processes of their own, in a ROS domain of their own. Left out: stamps of log lines, empty lines, and what differs from
run to run (`T`, `N`, `H`, `P`, `S`). Where no `ros2` is on the PATH, a few lines of rclpy stand in for it
([ros2_words.py](../../tools/transcript/ros2_words.py)); `topic echo` and `bag record` are then the suite's own
`eel_echo` and `record`.
"""
FIGURES = {
    frames_and_tools: "![The skin coloured by the torque C3, loads as arrows, the midline](../images/markers.png)\n\n"
    "*What the node `markers` published at 8.3 s, drawn by "
    "[marker_picture.py](../../tools/transcript/marker_picture.py). One square is 0.1 m.*\n"
}


def transcript(numbers: list[int]) -> str:
    """The sections of these `numbers`, from 1, as Markdown."""
    parts = []
    for number in numbers:
        section = SECTIONS[number - 1]
        with tempfile.TemporaryDirectory() as folder:
            shell = Shell(Path(folder))
            try:
                section(shell)
                if (Path(folder) / PICTURE.name).exists():
                    shutil.copy(Path(folder) / PICTURE.name, PICTURE)
            except BaseException:
                print("\n".join(shell.lines), file=sys.stderr)
                raise
            finally:
                shell.close()
        text = "\n".join(shell.lines).replace(folder, "FOLDER")
        parts.append(f"## {number}. {section.__doc__}\n```console\n{text}\n```\n" + FIGURES.get(section, ""))
        print(parts[-1], flush=True)
    return "\n".join(parts)


def main(words: list[str]) -> int:
    """Run the sections that the `words` number, all by default."""
    text = transcript([int(word) for word in words] or list(range(1, len(SECTIONS) + 1)))
    if not words:
        PAGE.write_text(f"{HEAD}\n{text}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
