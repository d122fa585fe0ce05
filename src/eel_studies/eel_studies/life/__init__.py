# SPDX-License-Identifier: Apache-2.0
"""`eel life`: swimmers from their own filmed motion, beside what was measured on them."""
