# SPDX-License-Identifier: Apache-2.0
"""`midlines`: measured midlines against those of the swimmer that follows them."""
