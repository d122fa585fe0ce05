# SPDX-License-Identifier: Apache-2.0
"""The march of a robot: a body that bends by itself."""
