# SPDX-License-Identifier: Apache-2.0
"""Code that all nodes of the suite share: parameters, command line, start, callbacks, signals, quality of service."""

import sys

# Every message imports rosidl_generator_py for its type support. With it comes the generator of message code, if it can
# be imported: its parsers take a sixth of a node's start, and no node generates code.
sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]  # None: no such module
