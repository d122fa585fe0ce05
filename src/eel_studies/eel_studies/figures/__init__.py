# SPDX-License-Identifier: Apache-2.0
"""The command `figures`: reproduces the paper's figures from our own runs, with tables beside them.

It needs matplotlib, which is imported only for drawing. Nothing else in the library needs this package.
"""
