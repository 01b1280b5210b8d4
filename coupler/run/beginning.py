"""The start of a run whose scene has `begin_from`: a state that another run has kept.

Components begin there before their outputs of the start are handed out, so that partners which do
not begin there see them where they are. Where the scene couples the same components in the same way
as that run did, what its coupling carries over from window to window is taken too, and the run goes
on with the same bits as that one would have.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from quintet.coupler.coupling.group import Group
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.files.run_files import read_marker
from quintet.coupler.scene.begin_table import Beginning
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError

State = Mapping[str, Any]


class Start:
    """Brings a coupling to the state that a scene begins from, or leaves it as it starts.

    Parameters
    ----------
    scene : Scene
    """

    def __init__(self, scene: Scene) -> None:
        self.beginning: Beginning | None = scene.beginning
        self.goes_on = bool(scene.beginning and scene.beginning.goes_on(scene.resolved))
        # Read now: the other run may be gone when this one ends.
        self.provenance = _provenance(scene.beginning)

    def begin(self, coupling: Coupling) -> None:
        """Have the components begin, once their ports are joined."""
        if self.beginning is None:
            return
        for name in self.beginning.components:
            coupling.components[name].begin_from(self._read(f"components/{name}"))

    def go_on(self, coupling: Coupling) -> None:
        """Take over what the coupling carries from window to window, if nothing else joins them."""
        if self.beginning is None or not self.goes_on:
            return
        # What partners told of the start may have changed a state: it is brought back.
        for name in self.beginning.components:
            coupling.components[name].begin_from(self._read(f"components/{name}"), goes_on=True)
        states, stretch = self._read("coupling"), self._read("tick") / coupling.windows.tick
        _take_over(coupling, states["own"], stretch)
        for name, state in states["groups"].items():
            _take_over_group(coupling.members[name], state, stretch)
        coupling.ledger.go_on(self._read("ledger"))

    def _read(self, name: str) -> Any:
        # Only scenes that begin from another run load HDF5 here.
        import h5py

        from quintet.coupler.files.stored_values import read_value

        assert self.beginning is not None
        path = self.beginning.path
        try:
            with h5py.File(path, "r", locking=False) as file:
                return read_value(file, name)
        except OSError as error:
            raise SceneError(
                f"begin_from: the state {path} must be a file that can be read; found {error}. Run "
                "that scene again, or name another run."
            ) from error


def _take_over(coupling: Coupling, state: State, stretch: float) -> None:
    """Take over what a coupling carried from window to window, at a time of 0.

    `stretch` is the tick of that run over the one of this.
    """
    _, _, current, calm = state["windows"]
    parts = {key: _outputs(getattr(coupling, key), state[key]) for key in ("outputs", "previous")}
    coupling.load({**state, **parts, "windows": [0, 0, round(current * stretch), calm]})


def _outputs(present: Mapping[str, Fields], saved: Mapping[str, Fields]) -> dict[str, Fields]:
    """Outputs as they were saved; those that nobody wanted in that run are as they start."""
    outputs: dict[str, Fields] = {}
    for name, fields in present.items():
        known = {key: array for key, array in saved[name].items() if key in fields}
        for key, array in known.items():
            if np.shape(array) != fields[key].shape:
                raise SceneError(
                    f"begin_from: {name}.{key} must have shape {fields[key].shape}; found "
                    f"{np.shape(array)}. Make both scenes alike, or leave {name} out of "
                    "begin_from.components."
                )
        outputs[name] = {**fields, **known}
    return outputs


def _take_over_group(group: Any, state: State, stretch: float) -> None:
    assert isinstance(group, Group)
    _take_over(group.coupling, state["coupling"], stretch)
    for name, inputs in group.inputs.items():
        inputs.load(state["inputs"][name])
    inner = [member for member in group.coupling.members.values() if isinstance(member, Group)]
    for member, saved in zip(inner, state["groups"], strict=True):
        _take_over_group(member, saved, stretch)


def _provenance(beginning: Beginning | None) -> dict[str, Any]:
    """What ``results.json`` says of the run that a scene begins from; {} of one that does not."""
    if beginning is None:
        return {}
    # Only scenes that begin from another run load HDF5 here.
    from quintet.coupler.files.states import hash_of, time_of

    marker = read_marker(beginning.folder)
    return {
        "begin_from": {
            "run": str(beginning.folder),
            "scene": str(beginning.scene.get("name", "")),
            "id": marker.run if marker else "",
            "state": beginning.path.name,
            "time": time_of(beginning.path),
            "hash": hash_of(beginning.path),
            "components": list(beginning.components),
        }
    }
