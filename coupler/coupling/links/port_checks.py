"""What the ports of a component lack for a role in a link."""

from collections.abc import Mapping

from quintet.coupler.coupling.link import Ports
from quintet.interfaces.component import Port
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import DIMENSIONS


def requires(ports: Ports, name: str, takes: Port | None, gives: Port | None) -> list[str]:
    """List what a component's ports lack for a role in a link; empty when it fits."""
    lacks = []
    for verb, needed, offered in (("take", takes, ports[0]), ("give", gives, ports[1])):
        if needed is None:
            continue
        match = next((port for port in offered if port.name == needed.name), None)
        if match is not None:
            lacks += misfits(name, match, needed)
            continue
        remedies = (port.lacks for side in ports for port in side)
        remedy = dict(pair for pairs in remedies for pair in pairs).get(needed.name, "")
        lacks.append(f"{name} must {verb} a port {needed.name}{f': {remedy}' if remedy else ''}")
    return lacks


def fewest(complaints: list[list[str]]) -> str:
    """Say what is lacking for the roles that two components come nearest to."""
    least = min(map(len, complaints))
    return " or: ".join("; ".join(lacks) for lacks in complaints if len(lacks) == least)


def misfits(name: str, port: Port, needed: Port) -> list[str]:
    """Say which fields of a port are not as the other side has them."""
    theirs = {field.name: field for field in needed.fields}
    wrong = []
    for mine in port.fields:
        other = theirs.get(mine.name)
        place = f"{name}.{port.name}.{mine.name}"
        if other is None:
            wrong.append(f"{place} is not known to the other side ({', '.join(theirs)})")
        elif mine.unit != other.unit:
            wrong.append(f"{place} is in {mine.unit}, the other side's in {other.unit}")
        elif mine.centring != other.centring:
            wrong.append(f"{place} is {mine.centring}, the other side's {other.centring}")
        elif mine.shape != other.shape:
            wrong.append(f"{place} has shape {mine.shape}, the other side's {other.shape}")
        elif mine.kind != other.kind:
            wrong.append(f"{place} is a {mine.kind}, the other side's a {other.kind}")
    return wrong


def refuse_other_dimensions(name: str, ports: Mapping[str, Port]) -> None:
    """Refuse a side of two dimensions beside one of three."""
    planar = [
        component
        for component, port in ports.items()
        if any(field.name == DIMENSIONS.name for field in (*port.static, *port.requests))
    ]
    if len(planar) == 1:
        (solid,) = set(ports) - set(planar)
        raise SceneError(
            f"link {name}: both sides must have two dimensions or both three; {planar[0]} has two, "
            f"{solid} has three. Set dimensions = 2 in both, or 3 in both."
        )
