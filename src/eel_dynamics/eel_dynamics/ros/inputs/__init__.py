# SPDX-License-Identifier: Apache-2.0
"""The inputs of a run besides laws: commands, currents, external wrenches; and which of them a run waits for."""
