# SPDX-License-Identifier: Apache-2.0
"""The arrangements of views in a recording: Rerun blueprints, without data."""
