# SPDX-License-Identifier: Apache-2.0
"""Messages into Rerun recordings: where they go, what they hold, how they are read back."""
