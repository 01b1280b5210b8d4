"""Laws of what a component says of itself before it is stepped."""

import inspect
from collections import Counter

import numpy as np

from quintet.coupler.conform.trial import Trial, names
from quintet.coupler.conform.verdict import DoesNotApply, LawBroken, require, require_same_bits
from quintet.interfaces.component import Field, Port, Resources
from quintet.interfaces.units import INTEGRATED, check_unit, dimensions

SECOND = {"s": 1}
WATT = dimensions("W")


def it_is_made_and_joined(trial: Trial) -> None:
    """From the parameters of the case, without an error."""
    trial.build()


def its_ports_are_those_of_its_manifest(trial: Trial) -> None:
    """A scene is checked with the manifest's ports; the component must have just these."""
    component = trial.make()
    for verb, ports, announced in (
        ("takes", component.takes, trial.takes),
        ("gives", component.gives, trial.gives),
    ):
        require(
            tuple(ports) == tuple(announced),
            f"{verb}: a component must have the ports that its manifest tells of the same "
            f"parameters; it has {names(ports)}, the manifest {names(announced)}, or their fields "
            "differ. Make both with one function.",
        )


def names_are_told_apart(trial: Trial) -> None:
    """Ports of one direction, and fields of one port, have names of their own, without a dot."""
    for verb, ports in (("takes", trial.takes), ("gives", trial.gives)):
        _require_distinct(verb, names(ports))
        for port in ports:
            where = f"{verb} {port.name}"
            _require_distinct(
                where, [field.name for field in (*port.fields, *port.static, *port.requests)]
            )
            known = {field.name for field in port.fields}
            for field in port.fields:
                require(
                    field.rate in known | {""},
                    f"{where}.{field.name}: its rate must be a field of the same port "
                    f"({', '.join(sorted(known))}); found {field.rate}. Correct it.",
                )


def _require_distinct(where: str, names: list[str]) -> None:
    for name, count in Counter(names).items():
        require(
            count == 1 and bool(name) and "." not in name,
            f"{where}: names must be there once and without a dot; found {name!r} {count} times. "
            "Rename it.",
        )


def units_fit_each_other(trial: Trial) -> None:
    """A rate is its value per second; a force times the velocity it works with is a power."""
    for ports, others in ((trial.takes, trial.gives), (trial.gives, trial.takes)):
        across = {field.name: field for port in others for field in port.fields}
        for port in ports:
            own_fields = {field.name: field for field in port.fields}
            for field in (*port.fields, *port.static, *port.requests):
                check_unit(field.unit, f"{port.name}.{field.name}", field.centring)
            for field in port.fields:
                _check_rate(port, field, own_fields.get(field.rate))
                _check_work(port, field, across.get(field.works_with))


def _check_rate(port: Port, field: Field, rate: Field | None) -> None:
    where = f"{port.name}.{field.name}"
    if field.centring == "impulse":
        whole = INTEGRATED[field.unit]
        require(
            dimensions(whole) == _product(dimensions(field.unit), SECOND),
            f"{where}: an impulse's unit times s must be that of its integral; found {field.unit} "
            f"and {whole}. Correct what add_unit was given.",
        )
    if rate is not None:
        require(
            _product(dimensions(rate.unit), SECOND) == dimensions(field.unit),
            f"{where} in {field.unit}: its rate must be in that per second; {rate.name} is in "
            f"{rate.unit}. Correct the units.",
        )


def _check_work(port: Port, field: Field, velocity: Field | None) -> None:
    if velocity is None:
        return
    require(
        _product(dimensions(field.unit), dimensions(velocity.unit)) == WATT,
        f"{port.name}.{field.name} in {field.unit}: times the velocity that it works with it must "
        f"be a power, W; {velocity.name} is in {velocity.unit}. Correct the units, or leave out "
        "works_with.",
    )


def _product(first: dict[str, int], other: dict[str, int]) -> dict[str, int]:
    powers = Counter(first)
    powers.update(other)
    return {base: power for base, power in powers.items() if power}


def describe_tells_what_its_ports_announce(trial: Trial) -> None:
    """Static fields of the ports given, requests of those taken: all of them, in their shapes."""
    component = trial.make()
    static = {f"{port.name}.{field.name}": field for port in trial.gives for field in port.static}
    requests = {
        f"{port.name}.{field.name}": field for port in trial.takes for field in port.requests
    }
    announced, described = static | requests, component.describe()
    for key in sorted(announced.keys() - described.keys()):
        raise LawBroken(
            f"describe: every static field that a port announces must be given; {key} is missing. "
            "Tell it, or leave it out of the port."
        )
    for key, array in described.items():
        require(
            key in announced,
            f"describe: only what ports announce may be given ({', '.join(announced) or 'nothing'}"
            f"); found {key}. Announce it as a static field of its port.",
        )
        shape = announced[key].shape
        require(
            array.shape[1:] == shape and array.ndim == len(shape) + 1,
            f"describe: {key} must have shape (n, {', '.join(map(str, shape))}) as its port says; "
            f"found {array.shape}. Correct describe, or the port.",
        )
        require(
            bool(np.isfinite(array).all()),
            f"describe: {key} must be finite; found {array[~np.isfinite(array)][:1]}. Correct it.",
        )
    repeated = component.describe()
    require_same_bits(
        repeated, described, "describe: called twice it must return the same", "Keep it so."
    )


def it_is_made_with_resources_or_without(trial: Trial) -> None:
    """Two threads are taken without an error; resources that may be left out change no bit.

    Without resources a class that serves devices too is on the processor, whose own cases try it.
    """
    cls = trial.manifest.load(trial.case.device)
    taken = list(inspect.signature(cls).parameters.values())
    if len(taken) < 2:
        raise DoesNotApply("its constructor takes no resources")
    trial.move(trial.build(threads=2))
    is_of_processor = cls is trial.manifest.load()
    if taken[1].default is inspect.Parameter.empty or (
        trial.case.device != "cpu" and is_of_processor
    ):
        return
    resources = Resources(folder=trial.folder, device=trial.case.device)
    outputs_alone = trial.join(cls(trial.params, resources))
    without = trial.join(cls(trial.params))
    require_same_bits(
        trial.move(without)[-1],
        trial.move(outputs_alone)[-1],
        "without resources it must do what it does with one thread",
        "Let the default be one thread.",
    )
