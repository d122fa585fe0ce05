# SPDX-License-Identifier: Apache-2.0
"""Other codes beside the library, each in an environment of its own: its script lies in `peers`."""
