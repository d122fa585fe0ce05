# SPDX-License-Identifier: Apache-2.0
"""The commands `eel simulate`, `eel ballast` and `eel urdf`, and the options that commands share."""
