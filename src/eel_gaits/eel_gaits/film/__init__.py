# SPDX-License-Identifier: Apache-2.0
"""Filmed swimmers in biologists' file formats: tracked points, their repair, and the mean beat fitted to them."""
