# SPDX-License-Identifier: Apache-2.0
"""The parts of robots: fins, joints and motors."""
