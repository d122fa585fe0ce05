# SPDX-License-Identifier: Apache-2.0
"""What every command of the suite uses: numbers with bounds, values in messages, one-line errors, whole files."""
