"""One swimmer of a batch: a `Simulation` that shares what is tabulated with the others of equal body, scene, stations.

What a single run does twice, to be ready for a law that comes later, is done once: the law is known from the start.
"""

from threading import Lock
from weakref import WeakKeyDictionary

import numpy as np
from eel_gaits.law import Law

from .body import Body
from .drive import Tabulation
from .profiles import Profiles, station_fields_of
from .quadrature import Grid
from .scene import Scene
from .sections import panels_of, stations_of, swimmer_of
from .shape import waves_of_law
from .simulation import Simulation, SimulationStopped
from .wrench import balance_of

MOST_TABLES = 256  # kept at a time: a batch of as many bodies as swimmers has nothing to share


class Tables:
    """Tables of a batch, made once for equal bodies, scenes, resolutions and stations. For several threads."""

    def __init__(self):
        self._made, self._lock = {}, Lock()
        self._number = WeakKeyDictionary()  # of each body: it has no equality but identity

    def of(self, body: Body, scene: Scene, resolution: float, x: np.ndarray):
        """Grid, `Swimmer`, `Stations` and `Tabulation`: read, never written to."""
        with self._lock:
            number = self._number.setdefault(body, len(self._number))
        key = number, scene, resolution, x.tobytes()
        tables = self._made.get(key)
        if tables is None:
            tables = self._make(body, scene, resolution, x)
            with self._lock:
                if len(self._made) >= MOST_TABLES:
                    self._made.clear()
                self._made[key] = tables
        return tables

    @staticmethod
    def _make(body: Body, scene: Scene, resolution: float, x: np.ndarray):
        grid = Grid.of(panels_of(body, resolution))
        stations = stations_of(body, scene, grid, x)
        base = np.where(stations.node >= 0, grid.x[stations.node], 0.0)
        return grid, swimmer_of(body, scene, grid), stations, Tabulation(grid.x, grid.previous, x, base)


class Member(Simulation):
    """As `Simulation` with `law` adopted, on the `tables` of a batch. `ValueError` names what does not fit."""

    def __init__(self, tables: Tables, law: Law, **arguments):
        self._first_law, self._tables = law, tables
        super().__init__(**arguments)
        self.adopt(law)

    def _build(self, resolution: float):
        self._resolution = max(
            resolution, self.accuracy.points_per_length(waves_of_law(self._first_law, self.body.length))
        )
        tables = self._tables.of(self.body, self.scene, self._resolution, self.x)
        self._grid, self.swimmer, self._stations, self._tabulation = tables
        self.balance = balance_of(len(self._grid.x))
        self._here = station_fields_of(len(self.x))

    def _take_initial_state(self):
        if self.shape.law is not None:
            super()._take_initial_state()

    def swim_into(
        self, times, out: Profiles, works, *, wrench: bool, load: bool
    ) -> tuple[int, SimulationStopped | None]:
        """March through `times` (T,) [s] and fill `out` and `works` (T, 4) [J]. Returns how many instants were reached,
        and what stopped it."""
        self._started = True
        return self._swim_through(times, works, out, wrench, load)
