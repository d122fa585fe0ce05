# SPDX-License-Identifier: Apache-2.0
"""Water that moves: flows without the swimmer, built in or given as functions."""
