# SPDX-License-Identifier: Apache-2.0
"""Motions without a closed form: functions, measured midlines and joint angles. They become rows in time and X."""
