# SPDX-License-Identifier: Apache-2.0
"""`eel laws`: laws of swimming that were found on animals, beside swims of the model."""
