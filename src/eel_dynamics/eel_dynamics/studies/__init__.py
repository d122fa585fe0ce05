# SPDX-License-Identifier: Apache-2.0
"""Studies of many runs, each with a command of its own. They alone import matplotlib and Dask."""
