# SPDX-License-Identifier: Apache-2.0
"""The policies of train_policy.py: rows of weights, one for each value of the action."""

from pathlib import Path

import numpy as np


def file_of(task: str) -> Path:
    """The file of the policy for the `task`."""
    return Path(__file__).with_name(f"policy_{task}.json")


def actions_of(weights: np.ndarray, observations: np.ndarray) -> np.ndarray:
    """The actions (n, A) of policies `weights` (n, A, O + 1) or (A, O + 1) at `observations` (n, O)."""
    return np.tanh(np.einsum("...ao,...o->...a", weights[..., :-1], observations) + weights[..., -1])
