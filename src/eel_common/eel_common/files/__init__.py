# SPDX-License-Identifier: Apache-2.0
"""Input files, read within bounds. Output files, written completely or not at all."""
