# SPDX-License-Identifier: Apache-2.0
"""Make the ROS wheels of this virtual environment usable by CMake, and keep colcon out of it.

The wheels' CMake files name the Python of the machine that built them (/opt/python/cp3xx-cp3xx/...), which does not
exist here; CMake then stops with "non-existent path". They are replaced by this interpreter's own include folders.
One of them reads a list of files as ASCII, and loses those in a folder whose name is not: it is told that it is UTF-8.
The six generators of a message each parse its definition, which is most of their time: the first keeps what it found.
"""

import re
import sys
import sysconfig
from pathlib import Path

import numpy

BUILDER_INCLUDE = re.compile(r"/opt/python/cp3\d+-cp3\d+/include/python3\.\d+")
BUILDER_NUMPY = re.compile(r"/opt/python/cp3\d+-cp3\d+/lib/python3\.\d+/site-packages/numpy/_?core/include")
LIST_OF_FILES = re.compile(r"(file\(STRINGS \S+ idl_tuples)\)")
BUILDER_PREFIX = re.compile(r"/opt/python/cp3\d+-cp3\d+")

PARSES = "    return _parser.parse(idl_string)\n"
PARSES_ONCE = """\
    import hashlib, pickle, tempfile
    kept = os.path.join('rosidl_parsed', hashlib.sha256(idl_string.encode()).hexdigest())
    if os.path.exists(kept):
        with open(kept, 'rb') as file:
            return pickle.load(file)
    tree = _parser.parse(idl_string)
    if os.path.exists('CMakeCache.txt'):  # a folder of a build
        os.makedirs('rosidl_parsed', exist_ok=True)
        with tempfile.NamedTemporaryFile(dir='rosidl_parsed', delete=False) as file:
            pickle.dump(tree, file)
        os.replace(file.name, kept)
    return tree
"""


def main() -> None:
    prefix = Path(sys.prefix)
    include = sysconfig.get_paths()["include"]
    changed = 0
    for path in (prefix / "share").rglob("*.cmake"):
        text = path.read_text()
        fixed = BUILDER_INCLUDE.sub(include, BUILDER_NUMPY.sub(numpy.get_include(), text))
        fixed = LIST_OF_FILES.sub(r"\1 ENCODING UTF-8)", fixed)
        if fixed != text:
            replace(path, fixed)
            changed += 1
    parser = Path(sysconfig.get_paths()["purelib"], "rosidl_parser/parser.py")
    replace(parser, parser.read_text().replace(PARSES, PARSES_ONCE))
    for path in (prefix / "share/ament_index/resource_index/parent_prefix_path").iterdir():
        replace(path, BUILDER_PREFIX.sub(str(prefix), path.read_text()))
    (prefix / "COLCON_IGNORE").touch()
    (prefix / "local_setup.sh").touch()  # colcon takes a prefix without one for a mistake, and says so
    print(f"paths set right in {changed} CMake files")


def replace(path: Path, text: str) -> None:
    """A new file in the place of `path`: the old one is a hard link to what uv keeps for other environments."""
    path.unlink()
    path.write_text(text)


if __name__ == "__main__":
    main()
