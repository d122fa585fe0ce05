# SPDX-License-Identifier: Apache-2.0
"""The paper's figures from our own runs, with tables beside them."""
