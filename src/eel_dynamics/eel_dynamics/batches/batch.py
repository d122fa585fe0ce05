# SPDX-License-Identifier: Apache-2.0
"""Many swimmers at once: the result of `simulate_batch`."""

import os
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from eel_common.cell import cell_of
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.analysis.measures import MEASURES, measures_of
from eel_dynamics.analysis.settling import tell_unsettled
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.equality import same_fields
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.run_data import ObservedArrays
from eel_dynamics.runs.run_picture import lines_of_batch, picture_of_batch
from eel_dynamics.runs.storage.netcdf import loaded, write
from eel_dynamics.runs.storage.run_contents import OF_EACH, contents_of_batch, own_of_batch
from eel_dynamics.runs.storage.tables import dataset_of, frame_of_all, needed
from eel_dynamics.runs.storage.variables import (
    COUNTS,
    OWN,
    PARTS,
    Contents,
    documented_arrays,
    fields_of_arrays,
    names_with,
    shape_of,
)
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS
from eel_dynamics.simulation.stopping import SimulationStopped

ALONG = "backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force", "fluid_force"


@documented_arrays("batch")
@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Batch(ObservedArrays):
    """B swimmers, T samples, M stations, in the axes and units of `Run`.

    After the last valid sample of a swimmer that stopped, values are 0, see `valid`. Profiles are None without
    stations. Wrench and energy are None unless every scene has them, fluid_force without `load`. `energy` has one (B,
    T) array per field. The joints' arrays are None without a robot; J and N are the greatest of any, and the rest is
    filled with 0. Two batches are equal if all their fields are. Arrays:
    """

    laws: tuple[Law | SampledLaw, ...]
    bodies: tuple[Body, ...]
    scenes: tuple[Scene, ...]
    accuracies: tuple[Accuracy, ...]
    samples: np.ndarray
    error: tuple[SimulationStopped | None, ...]  #: reason why each swimmer stopped: time, quantity, value, hint
    steps: np.ndarray
    evaluations: np.ndarray
    nodes: np.ndarray
    error_estimates: tuple[ErrorEstimate | None, ...]  #: None if not requested, or if the swimmer stopped
    backbone: np.ndarray | None
    section_orientation: np.ndarray | None
    curvature: np.ndarray | None
    curvature_rate: np.ndarray | None
    flows: tuple[Flow | None, ...] = ()
    robots: tuple[Robot | None, ...] = ()
    fins: tuple[tuple[Fin, ...], ...] = ()  #: of each swimmer; arrays are padded with 0 up to F
    wrenches: tuple[tuple[ExternalWrench, ...], ...] = ()  #: from outside, of each swimmer
    _arrays: dict[str, np.ndarray] = field(default_factory=dict)  # all arrays, as from `storage.variables.arrays_of`
    _energy_at_start: np.ndarray | None = None  # (B,) J

    def __len__(self) -> int:
        return len(self.laws)

    def __eq__(self, other: object) -> bool:
        return self is other or same_fields(self, other)

    def __hash__(self) -> int:
        return hash((self.laws, self.bodies, self.scenes))

    def __repr__(self) -> str:
        return (
            f"Batch({len(self)} swimmers, {len(self.time)} samples, {self.x.shape[1]} stations, "
            f"{np.count_nonzero(self.stopped)} stopped)"
        )

    def plot(self) -> Any:
        """A matplotlib figure: paths and speeds of the heads. `ImportError` without matplotlib."""
        return picture_of_batch(self)

    def _repr_html_(self) -> str:
        return cell_of(self.plot, lines_of_batch(self))

    def _contents(self) -> Contents:
        assert self._energy_at_start is not None
        return contents_of_batch(self, self._arrays, self._energy_at_start)

    @property
    def valid(self) -> np.ndarray:
        """(B, T) bool: valid samples."""
        return np.arange(len(self.time)) < self.samples[:, None]

    @property
    def stopped(self) -> np.ndarray:
        """(B,) bool: swimmers that stopped before the end."""
        return np.array([error is not None for error in self.error])

    @property
    def above_target(self) -> np.ndarray:
        """(B,) bool: swimmers whose estimated error exceeds their target."""
        pairs = zip(self.error_estimates, self.accuracies, strict=True)
        return np.array([bool(error and error.over_target(each.target, float(self.time[-1]))) for error, each in pairs])

    def __getitem__(self, index: int) -> Run:
        """Swimmer `index` as a `Run`, with its valid samples."""
        index = range(len(self))[index]
        done, x = int(self.samples[index]), self.x[index]
        own: dict[str, Any] = {one: getattr(self, several)[index] for one, several in OF_EACH.items()}
        own |= {name: int(getattr(self, name)[index]) for name in COUNTS}
        scene, fins, robot = own["scene"], own["fins"], own["robot"]
        names = names_with(
            wrench=scene.internal_wrench and self.backbone is not None,
            load=self.fluid_force is not None,
            ledger=scene.ledger,
            fins=fins,
            robot=robot is not None,
        )
        sizes = {"time": done, "station": len(x), "fin": len(fins)} | coordinates_of(robot)
        arrays = {
            name: self._arrays[name][index][tuple(map(slice, shape_of(name, sizes)))]
            for name in names
            if name in self._arrays
        }
        found = fields_of_arrays(arrays | {"time": self.time[:done], "x": x}, robot)
        return Run(**found, **own)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the whole batch to a netCDF file (.nc), like `Run.save`."""
        write(self._contents(), path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "Batch":
        """The batch that `save` wrote. `ValueError` in one line as in `Run.load`."""
        batch: Batch = loaded(path, "batch", _batch_from)
        return batch

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` like that of `Run.to_xarray`, with a first dimension `swimmer`."""
        return dataset_of(self._contents())

    def to_dataframe(self) -> Any:
        """A `pandas.DataFrame` like that of `Run.to_dataframe`, by swimmer and time; only valid samples."""
        return frame_of_all(self[index] for index in range(len(self)))

    def analysis(self) -> Any:
        """A `pandas.DataFrame` with a row for each swimmer: its measures, and the `error` that stopped it, or "".

        The measures are those of a sweep (`eel_dynamics.analysis.measures`): NaN if undefined, and for a swimmer that
        stopped. An `Unsettled` warning counts the gaits that have not settled.
        """
        pandas = needed("pandas", "analysis")
        rows = [{} if error else measures_of(self[index]) for index, error in enumerate(self.error)]
        frame = pandas.DataFrame(rows, columns=list(MEASURES), index=pandas.RangeIndex(len(self), name="swimmer"))
        tell_unsettled(frame["settled"], "swimmers")
        return frame.assign(error=[str(error or "") for error in self.error])


def coordinates_of(robot: Robot | None) -> dict[str, int]:
    """The numbers of joints and modes of a `robot`, as sizes of these dimensions."""
    return {"joint": 0, "mode": 0} if robot is None else {"joint": len(robot.joints), "mode": robot.mode_count}


def batch_of(
    own: dict[str, Any],
    counts: dict[str, np.ndarray],
    time: np.ndarray,
    x: np.ndarray,
    arrays: dict[str, np.ndarray],
    start: np.ndarray,
    stations: bool,
) -> Batch:
    """The batch of B swimmers, from each one's `own` fields by name, its `counts`, and all `arrays`.

    start (B,) [J]: energies at the start. stations: whether there are profiles.
    """
    wrench = all(each.internal_wrench for each in own["scenes"])
    none = [*(() if stations else ALONG), *(() if wrench else ("torque", "force"))]
    if any(own["robots"]):
        arrays = dict.fromkeys(JOINT_ARRAYS, np.zeros((*arrays["position"].shape[:2], 0))) | arrays
    energy = fields_of_arrays(arrays, None)["energy"] if all(each.ledger for each in own["scenes"]) else None
    names = {item.name for item in fields(Batch)} & OWN.keys() - {"time", "x"}
    found: dict[str, Any] = {name: tuple(values) for name, values in own.items()} | counts
    found |= dict.fromkeys(names) | {name: arrays[name] for name in names & arrays.keys()} | dict.fromkeys(none)
    full = {name: array for name, array in arrays.items() if array.size}
    return Batch(time=time, x=x, energy=energy, _arrays=full, _energy_at_start=start, **found)


def _batch_from(contents: Contents) -> Batch:
    """The batch with these contents."""
    arrays, own = contents.arrays, own_of_batch(contents)
    there = {part: PARTS[part][0] in arrays for part in ("wrench", "load", "fins")}  # zeros in older files
    ours = {name: arrays[name] for name in names_with(**there) if name in arrays}
    counts = {name: arrays[name].astype(int) for name in ("samples", *COUNTS)}
    time, x, start = (arrays[name] for name in ("time", "x", "energy_at_start"))
    return batch_of(own, counts, time, x, ours, start, bool(contents.values["stations"]))
