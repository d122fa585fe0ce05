# SPDX-License-Identifier: Apache-2.0
"""Can a swimmer be steered? The linearised motion over one period of its gait."""
