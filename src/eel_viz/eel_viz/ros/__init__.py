# SPDX-License-Identifier: Apache-2.0
"""The nodes `visualiser` and `markers`."""
