# SPDX-License-Identifier: Apache-2.0
"""Least squares with errors correlated in time, and the resulting intervals.

Errors of one path's axis at times t_j, t_k have the covariance s^2 rho^(|t_j - t_k| / d), d the median step in time: an
autoregressive process of order 1; rho = 0 is white noise. The factor rho maximises the restricted likelihood of the
residuals (Patterson and Thompson, Biometrika 58 (1971)), which accounts for the fitted unknowns.
"""

from typing import NamedTuple

import numpy as np

MOST_CORRELATED = 0.999
SINGULAR = 1e-6  # ratio of the least to the greatest sensitivity, below which derivatives are round-off
NAMED = 0.1  # a parameter with a larger share of a combination is named


class Block(NamedTuple):
    """Residuals in time order, and their derivatives: one axis of a path, or one speed."""

    step: np.ndarray  # (n - 1,) times between them, in units of the median
    residual: np.ndarray  # (n,) measured minus predicted
    derivative: np.ndarray  # (n, P + Q) of the prediction, by parameters and placements


def whitened(blocks: list[Block], correlation: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Residuals (N,) and derivatives (N, P + Q) scaled to independent errors of equal size, and log|V| of the
    errors."""
    rows, log = [], 0.0
    for block in blocks:
        both = np.column_stack((block.residual, block.derivative))
        factor = correlation ** block.step[:, None] if correlation else np.zeros((len(block.step), 1))
        left = 1.0 - factor**2
        rows += [both[:1], (both[1:] - factor * both[:-1]) / np.sqrt(left)]
        log += float(np.sum(np.log(left)))
    whole = np.concatenate(rows)
    return whole[:, 0], whole[:, 1:], log


def correlation_of(blocks: list[Block]) -> float:
    """The rho of greatest restricted likelihood; 0 if no residuals are successive in time."""
    from scipy.optimize import minimize_scalar

    if not any(len(block.step) for block in blocks):
        return 0.0

    def loss(correlation: float) -> float:
        residual, derivative, log = whitened(blocks, correlation)
        basis, triangle = np.linalg.qr(derivative)
        left = residual - basis @ (basis.T @ residual)
        free = len(residual) - derivative.shape[1]
        information = 2.0 * np.sum(np.log(np.abs(np.diag(triangle)) + np.finfo(float).tiny))
        return float(free * np.log(left @ left + np.finfo(float).tiny) + log + information)

    found = minimize_scalar(loss, bounds=(0.0, MOST_CORRELATED), method="bounded", options={"xatol": 1e-4})
    return float(found.x) if found.fun < loss(0.0) else 0.0


def gauss_newton_covariance(blocks: list[Block], correlation: float) -> tuple[np.ndarray, float]:
    """Covariance (P + Q, P + Q) of the unknowns for errors of size 1, and the sum of squares of the errors."""
    residual, derivative, _ = whitened(blocks, correlation)
    basis, triangle = np.linalg.qr(derivative)
    inverse = np.linalg.inv(triangle)
    left = residual - basis @ (basis.T @ residual)
    return inverse @ inverse.T, float(left @ left)


def undetermined(blocks: list[Block], names: tuple[str, ...], values: np.ndarray) -> str:
    """The relative changes of the parameters that do not change the measurements, in words; empty if there are none.

    Placements are projected out: an effect that a placement can cancel does not determine a parameter.
    """
    derivative = np.concatenate([block.derivative for block in blocks])
    sensitivity, placement = derivative[:, : len(names)] * values, derivative[:, len(names) :]
    if placement.shape[1]:
        basis, size, _ = np.linalg.svd(placement, full_matrices=False)
        basis = basis[:, size > 1e-12 * size[0]]
        sensitivity = sensitivity - basis @ (basis.T @ sensitivity)
    _, size, combinations = np.linalg.svd(sensitivity, full_matrices=True)
    least = size[len(names) - 1] if len(size) == len(names) else 0.0
    if least > SINGULAR * size[0]:
        return ""
    share = combinations[-1] / combinations[-1][np.argmax(np.abs(combinations[-1]))]
    parts = [
        f"{name} ({part:+.0%})" for name, part in zip(names, 0.01 * share, strict=True) if abs(part) > 0.01 * NAMED
    ]
    return " with ".join(parts)
