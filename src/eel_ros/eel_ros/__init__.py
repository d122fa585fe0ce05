# SPDX-License-Identifier: Apache-2.0
"""Code that all nodes of the suite share: parameters, command line, start, callbacks, signals, quality of service."""
