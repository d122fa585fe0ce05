# SPDX-License-Identifier: Apache-2.0
"""Moving water: undisturbed flows, built in or given as functions."""
