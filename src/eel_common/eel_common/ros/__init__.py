# SPDX-License-Identifier: Apache-2.0
"""Code that all nodes of the suite share: parameters, command line, start, callbacks, signals, quality of service."""

import sys

# Every message imports rosidl_generator_py for its type support, and with it the generator of message code. Importing
# that takes a sixth of a node's start, and no node generates code.
sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]  # None: the import fails
