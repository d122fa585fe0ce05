# SPDX-License-Identifier: Apache-2.0
"""The model: body, scene, section data, the grid along the body, the initial state, and checks of arguments."""
