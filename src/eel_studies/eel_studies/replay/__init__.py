# SPDX-License-Identifier: Apache-2.0
"""`eel replay-joints`: robots from the log of their joints, with a band from what is uncertain."""
