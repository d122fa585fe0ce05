# SPDX-License-Identifier: Apache-2.0
"""What robots have and eels do not: fins, joints and motors."""
