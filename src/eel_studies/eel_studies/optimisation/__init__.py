# SPDX-License-Identifier: Apache-2.0
"""The function and the command `optimise`: the gait of least cost for each speed."""
