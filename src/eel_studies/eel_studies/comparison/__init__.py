# SPDX-License-Identifier: Apache-2.0
"""`eel compare`: two runs side by side."""
