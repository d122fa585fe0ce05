# SPDX-License-Identifier: Apache-2.0
"""The commands `eel simulate` and `eel ballast`, and the options that commands share."""
