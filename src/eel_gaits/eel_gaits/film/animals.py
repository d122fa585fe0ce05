# SPDX-License-Identifier: Apache-2.0
"""Selects the tracks of one swimmer: a tracker that loses an animal gives it a new name.

Tracks without a common frame are one animal if each starts near the place that the other was moving to. Of several such
animals, the one seen in most frames is taken. Tracks with common frames need the user's choice.
"""

from collections.abc import Iterable

import numpy as np
from eel_common.wording import shown

from eel_gaits.film.forms import Tracks

APART, LOST = 0.25, 0.5  # largest distance from the expected place: of the length, and of the way since
NAMED = 8  # names in a message
MOST_SCORE = 2.0  # peaks of SLEAP's maps go a little beyond 1


def of_one(tracks: Tracks, animal: str | None, likely: float) -> tuple[np.ndarray, np.ndarray, list[str], list[str]]:
    """Points (N, n, 2) of one animal, the mask (N, n) of points with scores below `likely`, the points' names (n,), and
    notes.

    animal: its name, or the names of its tracks with commas between them. In a common frame the track with most points
    is taken, of equals the first.
    """
    given = {name: points for name, points in tracks.animals.items() if _there(points).any()}
    tracks = tracks._replace(animals={name: _sure(tracks, name, likely) for name in tracks.animals})
    seen = {name: _there(points) for name, points in tracks.animals.items()}
    seen = {name: seen[name] for name in sorted(seen, key=lambda name: np.argmax(seen[name])) if seen[name].any()}
    wanted = list(seen)
    if animal is not None:
        wanted = [animal] if animal in tracks.animals else [name.strip() for name in animal.split(",")]
        if unknown := [name for name in wanted if name not in tracks.animals]:
            raise ValueError(f"there is no animal {shown(unknown[0])}, there are: {_listed(seen)}")
    names = [name for name in seen if name in wanted]
    if not names:
        low = f" or have a likelihood below {likely:g}" if given else ""
        raise ValueError(f"all its points are missing{low}")
    if animal is None and np.any(np.sum([seen[name] for name in names], axis=0) > 1):
        raise ValueError(f"it has {len(names)} animals, {_listed(names)}: say which one, or which tracks are one")
    if any(tracks.names[name] != tracks.names[names[0]] for name in names):
        raise ValueError(f"it has {len(names)} animals with other points, {_listed(names)}: say which one")
    groups: list[list[str]] = []
    for name in names:
        group = next((each for each in groups if animal is not None or _is_one(tracks, each, name)), [])
        groups += [] if group else [group]
        group.append(name)
    one = max(groups, key=lambda group: sum(int(seen[name].sum()) for name in group))
    why = "" if animal is not None else ", as they share no frame and follow each other"
    notes = [f"tracks {_listed(one)} joined{why}"] if len(one) > 1 else []
    if out := [name for name in given if name not in one]:
        notes.append(f"animal {_listed(one)} taken, left out: {_listed(out)}")
    points = _merged(tracks.animals, one)
    low = np.isfinite(_merged(given, one)).all(axis=2) & ~np.isfinite(points).all(axis=2)
    return points, low, tracks.names[one[0]], notes


def _sure(tracks: Tracks, name: str, likely: float) -> np.ndarray:
    """The points (N, n, 2) of a track, NaN where their score is below `likely`."""
    points, scores = tracks.animals[name], tracks.scores.get(name)
    if scores is None:
        return points
    if np.any(scores > MOST_SCORE):
        raise ValueError(f"likelihoods and scores must be from 0 to about 1, got {np.nanmax(scores):g}: in percent?")
    return np.where((scores < likely)[..., None], np.nan, points)


def _is_one(tracks: Tracks, group: list[str], name: str) -> bool:
    """Whether each track, of the `group` and the named one, starts about where the one before it was moving to."""
    one, other = _merged(tracks.animals, group), tracks.animals[name]
    mine, both = _there(one), np.flatnonzero(_there(one) | _there(other))
    length = np.nanmedian(np.nansum(np.linalg.norm(np.diff(one[mine], axis=1), axis=2), axis=1))
    first, last = np.flatnonzero(mine)[[0, -1]]
    pace = np.nan_to_num(_way(one[first], one[last])) / max(tracks.time[last] - tracks.time[first], 1.0)
    points = np.where(mine[:, None, None], one, other)
    for place in np.flatnonzero(np.diff(mine[both])):
        before, after = both[place : place + 2]
        way = pace * (tracks.time[after] - tracks.time[before])
        beside = np.linalg.norm(_way(points[before], points[after]) - way)
        if not beside <= APART * length + LOST * np.linalg.norm(way):
            return False
    return True


def _way(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The mean displacement (2,) of the points (n, 2) seen both before and after; NaN without any."""
    ways = (after - before)[np.isfinite(after - before).all(axis=1)]
    return np.asarray(ways.mean(axis=0)) if len(ways) else np.full(2, np.nan)


def _there(points: np.ndarray) -> np.ndarray:
    """The frames (N,) in which any of the points (N, n, 2) is seen."""
    return np.asarray(np.isfinite(points).any(axis=(1, 2)))


def _merged(tracks: dict[str, np.ndarray], names: list[str]) -> np.ndarray:
    """The points (N, n, 2) of the tracks with these `names`; in each frame the track with most points, or the first."""
    found = tracks[names[0]].copy()
    most = np.isfinite(found).sum(axis=(1, 2))
    for name in names[1:]:
        count = np.isfinite(tracks[name]).sum(axis=(1, 2))
        found[count > most] = tracks[name][count > most]
        most = np.maximum(count, most)
    return found


def _listed(names: Iterable[str]) -> str:
    listed = [shown(name) for name in names]
    return ", ".join(listed[:NAMED]) + (f" and {len(listed) - NAMED} others" if len(listed) > NAMED else "")
