# SPDX-License-Identifier: Apache-2.0
"""Filmed swimmers, as biologists publish them: tracked points, their repair, and the mean beat that they give."""
