# SPDX-License-Identifier: Apache-2.0
"""Can a swimmer be steered? The motion linearised over one period of its gait."""
