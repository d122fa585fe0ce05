# SPDX-License-Identifier: Apache-2.0
"""Many swimmers at once: what `simulate_batch` returns."""

import os
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np
from eel_base.cell import cell_of
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from eel_model.body.body import Body
from eel_model.equality import same_fields
from eel_model.fins.fins import Fin
from eel_model.flow.flow import Flow
from eel_model.flow.plain import flow_of
from eel_model.robot.joint import Joint
from eel_model.robot.robot import Robot
from eel_model.scene import Scene

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.analysis.measures import MEASURES, measures_of
from eel_dynamics.analysis.settling import tell_unsettled
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.run_data import ObservedArrays
from eel_dynamics.runs.run_picture import lines_of_batch, picture_of_batch
from eel_dynamics.runs.storage import plain
from eel_dynamics.runs.storage.netcdf import loaded, write
from eel_dynamics.runs.storage.run_contents import contents_of_batch, fins_of, with_warnings
from eel_dynamics.runs.storage.tables import dataset_of, frame_of_all, needed
from eel_dynamics.runs.storage.variables import COUNTS, OWN, VARIABLES, Contents, documented_arrays, fields_of_arrays
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS
from eel_dynamics.simulation.observations import FINS, LOAD, WRENCH
from eel_dynamics.simulation.stopping import SimulationStopped

ALONG = "backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force", "fluid_force"


@documented_arrays("batch")
@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Batch(ObservedArrays):
    """B swimmers, T samples, M stations, in the axes and units of `Run`.

    Values after the last valid sample of a swimmer that stopped are 0, see `valid`. Profiles are None without stations;
    wrench and energy are None unless every scene has them, and fluid_force without `load`. `energy` has one (B, T)
    array per field. The joints' arrays are None without a robot; J and N are the most of any, 0 fills the rest.
    Two batches are equal where all their fields are. Arrays:
    """

    laws: tuple[Law | SampledLaw, ...]
    bodies: tuple[Body, ...]
    scenes: tuple[Scene, ...]
    accuracies: tuple[Accuracy, ...]
    samples: np.ndarray
    error: tuple[SimulationStopped | None, ...]  #: why each swimmer stopped: time, quantity, value, hint
    steps: np.ndarray
    evaluations: np.ndarray
    nodes: np.ndarray
    error_estimates: tuple[ErrorEstimate | None, ...]  #: None where none was wanted, or the swimmer stopped
    backbone: np.ndarray | None
    section_orientation: np.ndarray | None
    curvature: np.ndarray | None
    curvature_rate: np.ndarray | None
    flows: tuple[Flow | None, ...] = ()
    robots: tuple[Robot | None, ...] = ()
    fins: tuple[tuple[Fin, ...], ...] = ()  #: of each swimmer; fewer than F leave 0 in the arrays
    _arrays: dict[str, np.ndarray] = field(default_factory=dict)  # all, as of `storage.variables.arrays_of`
    _energy_at_start: np.ndarray | None = None  # (B,) J

    def __len__(self) -> int:
        return len(self.laws)

    def __eq__(self, other: object) -> bool:
        return self is other or same_fields(self, other)

    def __hash__(self) -> int:
        return hash((self.laws, self.bodies, self.scenes))

    def __reduce__(self) -> tuple[Any, ...]:  # each array once
        more = self.flows, self.robots, self.fins
        return _batch_from, (self._contents, self.laws, self.bodies, self.scenes, *more)

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

    @property
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
        """Swimmer `index` as a `Run`, with the samples that it has."""
        index = range(len(self))[index]
        scene, robot, done = self.scenes[index], self.robots[index], int(self.samples[index])
        law, body, flow, fins = self.laws[index], self.bodies[index], self.flows[index], self.fins[index]
        swimmer = Swimmer(law, body, scene, self.x[index], flow, robot, fins)
        parts = () if robot is None else robot.parts
        modes = [part.modes for part in parts if not isinstance(part, Joint)]
        most = {"fin": len(fins), "joint": len(parts) - len(modes), "mode": sum(modes)}
        there = (  # arrays, and whether this swimmer has them
            (WRENCH, scene.internal_wrench and self.backbone is not None),
            (LOAD, self.fluid_force is not None),
            (VARIABLES.keys() - OWN, scene.ledger),
            (FINS, bool(fins)),
            (JOINT_ARRAYS, robot is not None),
        )
        absent = {name for names, present in there if not present for name in names}
        arrays = {}
        for name, array in self._arrays.items():
            if name not in absent:
                own = most.get("".join(VARIABLES[name].dimensions[1:2]))  # of fins, joints and modes
                arrays[name] = array[index, :done] if own is None else array[index, :done, :own]
        return Run.of(
            swimmer,
            self.time[:done],
            arrays,
            law=law,
            accuracy=self.accuracies[index],
            steps=int(self.steps[index]),
            evaluations=int(self.evaluations[index]),
            nodes=int(self.nodes[index]),
            error_estimate=self.error_estimates[index],
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the whole batch to a netCDF file (.nc), as `Run.save` does a run."""
        write(with_warnings(self, self._contents), path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "Batch":
        """The batch that `save` wrote. `ValueError` in one line as in `Run.load`."""
        batch: Batch = loaded(path, "batch", _batch_from)
        return batch

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` as `Run.to_xarray` gives it, with a first dimension `swimmer`."""
        return dataset_of(with_warnings(self, self._contents))

    def to_dataframe(self) -> Any:
        """A `pandas.DataFrame` as `Run.to_dataframe` gives it, by swimmer and time; valid samples alone."""
        return frame_of_all(self[index] for index in range(len(self)))

    def analysis(self) -> Any:
        """A `pandas.DataFrame` with a row for each swimmer: its measures, and the `error` that stopped it, or "".

        The measures are those of a sweep (`eel_dynamics.analysis.measures`): NaN where one is undefined, and for a
        swimmer that stopped. An `Unsettled` warning tells how many gaits had not settled.
        """
        pandas = needed("pandas", "analysis")
        rows = [{} if error else measures_of(self[index]) for index, error in enumerate(self.error)]
        frame = pandas.DataFrame(rows, columns=list(MEASURES), index=pandas.RangeIndex(len(self), name="swimmer"))
        tell_unsettled(frame["settled"], "swimmers")
        return frame.assign(error=[str(error or "") for error in self.error])


class Swimmer(NamedTuple):
    """A swimmer of a batch: its law, its body in a scene, its stations (M,) [m], the flow of its water, what bends by
    itself, and its fins."""

    law: Law | SampledLaw
    body: Body
    scene: Scene
    x: np.ndarray
    flow: Flow | None
    robot: Robot | None
    fins: tuple[Fin, ...] = ()


def batch_of(
    swimmers: list[Swimmer],
    found: tuple[Any, ...],
    times: np.ndarray,
    arrays: dict[str, np.ndarray],
    start: np.ndarray,
    stations: bool,
) -> Batch:
    """The batch of these `swimmers`: what was `found` of each, and all `arrays` of them.

    start (B,) [J]: the energies there. stations: whether there are profiles.
    """
    settings, errors, estimates, (samples, steps, evaluations, nodes) = found
    scenes = tuple(each.scene for each in swimmers)
    wrench = all(each.internal_wrench for each in scenes)
    none = [*(() if stations else ALONG), *(() if wrench else ("torque", "force"))]
    if any(each.robot for each in swimmers):
        arrays = dict.fromkeys(JOINT_ARRAYS, np.zeros((*arrays["position"].shape[:2], 0))) | arrays
    energy = fields_of_arrays(arrays, None)["energy"] if all(each.ledger for each in scenes) else None
    names = {item.name for item in fields(Batch)} & OWN.keys() - {"time", "x"}
    return Batch(
        laws=tuple(each.law for each in swimmers),
        bodies=tuple(each.body for each in swimmers),
        scenes=scenes,
        accuracies=tuple(settings),
        time=times,
        samples=samples,
        error=tuple(errors),
        steps=steps,
        evaluations=evaluations,
        nodes=nodes,
        error_estimates=tuple(estimates),
        x=np.array([each.x for each in swimmers]),
        energy=energy,
        flows=tuple(each.flow for each in swimmers),
        robots=tuple(each.robot for each in swimmers),
        fins=tuple(each.fins for each in swimmers),
        _arrays={name: array for name, array in arrays.items() if array.size},
        _energy_at_start=start,
        **dict.fromkeys(names) | {name: arrays[name] for name in names & arrays.keys()} | dict.fromkeys(none),
    )


def _batch_from(
    contents: Contents,
    laws: Any = None,
    bodies: Any = None,
    scenes: Any = None,
    flows: Any = None,
    robots: Any = None,
    fins: Any = None,
) -> Batch:
    """The batch of these contents; the others too, where they are at hand."""
    values, arrays = contents.values, contents.arrays
    laws = laws or plain.row_of(values["laws"], plain.law_of)
    bodies = bodies or plain.row_of(values["bodies"], plain.body_of)
    scenes = scenes or plain.row_of(values["scenes"], lambda each: Scene(**each))
    settings = plain.row_of(values["accuracies"], plain.accuracy_of)
    errors = [plain.stop_of(each) for each in values["errors"]]
    estimates = [each and ErrorEstimate(**each) for each in values["error_estimates"]]
    counts = [arrays[name].astype(int) for name in ("samples", *COUNTS)]
    count = len(arrays["samples"])
    if any(len(each) != count for each in (laws, bodies, scenes, settings, errors, estimates)):
        raise ValueError(f"there must be a law, a body, a scene and settings for each of {count} swimmers")
    flows = flows or [flow_of(each) for each in values.get("flows", count * [None])]
    fins = fins or [fins_of(each) for each in values.get("fins", count * [()])]
    robots = robots or [
        plain.robot_of(each, body) for each, body in zip(values.get("robots", count * [None]), bodies, strict=True)
    ]
    swum = list(map(Swimmer, laws, bodies, scenes, arrays["x"], flows, robots, fins))
    absent = {name for group in (WRENCH, LOAD, FINS) if group[0] not in arrays for name in group}  # 0 in older files
    ours = {name: each for name, each in arrays.items() if name in VARIABLES.keys() - absent - {"time", "x"}}
    found = settings, errors, estimates, counts
    return batch_of(swum, found, arrays["time"], ours, arrays["energy_at_start"], bool(values["stations"]))
