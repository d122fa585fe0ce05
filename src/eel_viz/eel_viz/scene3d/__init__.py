# SPDX-License-Identifier: Apache-2.0
"""The swimmer and its surroundings in three dimensions."""
