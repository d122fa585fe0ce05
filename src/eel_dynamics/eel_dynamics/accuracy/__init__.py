# SPDX-License-Identifier: Apache-2.0
"""The accuracy of a run: settings from a target or from a budget of time."""
