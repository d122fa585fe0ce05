# SPDX-License-Identifier: Apache-2.0
"""Contrast of colours, and of what is drawn in a picture with its ground."""

import numpy as np

NEAR, BESIDE, LOOKED_AT = 24, 9, 60  # of 255: a pixel has a colour; pixels: what is its ground; most pixels


def contrast(letters: tuple, ground: tuple) -> float:
    """Contrast of letters on a ground, 1 to 21, as the Web Content Accessibility Guidelines 2.2 define it."""
    light = [np.array((0.2126, 0.7152, 0.0722)) @ linear(np.array(colour) / 255.0) for colour in (letters, ground)]
    return float((max(light) + 0.05) / (min(light) + 0.05))


def linear(share: np.ndarray) -> np.ndarray:
    """Intensity of sRGB's shares, 0 to 1."""
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def contrast_in(picture: np.ndarray, colour: tuple) -> float:
    """Median contrast of pixels of this `colour` in a `picture` (h, w, 3) with the most frequent other one beside them.

    0 where fewer than 20 pixels have the colour."""
    near = np.abs(picture - np.array(colour)).max(axis=2) <= NEAR
    places = np.argwhere(near)
    found = []
    for row, column in places[:: max(1, len(places) // LOOKED_AT)]:
        beside = (slice(max(0, at - BESIDE), at + BESIDE + 1) for at in (row, column))
        window = tuple(beside)
        others, counts = np.unique(picture[window][~near[window]], axis=0, return_counts=True)
        if len(others):
            found.append(contrast(picture[row, column], others[counts.argmax()]))
    return float(np.median(found)) if len(places) >= 20 and found else 0.0
