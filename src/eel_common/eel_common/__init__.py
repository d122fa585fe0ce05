# SPDX-License-Identifier: Apache-2.0
"""What every command uses: numbers with bounds, values in messages, one-line errors, files to be read and written."""
