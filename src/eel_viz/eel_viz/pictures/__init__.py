# SPDX-License-Identifier: Apache-2.0
"""Pictures and films of recordings, without a display: the command `render`."""
