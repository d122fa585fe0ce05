# SPDX-License-Identifier: Apache-2.0
"""Messages into Rerun recordings: destinations, content, and reading back."""
