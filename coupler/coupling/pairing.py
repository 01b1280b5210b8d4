"""What the ledger compares of a link, from its ports: equal sums of impulses, work of forces."""

from collections.abc import Mapping, Sequence

from quintet.coupler.coupling.link import Transfer
from quintet.interfaces.component import Field

Works = list[tuple[str, str, str]]  # force, velocity, position: all of one component
AllFields = Mapping[str, Mapping[str, Field]]  # component -> its fields, by their keys
INTEGRAL = "integral"  # in place of a position: the velocity is an impulse itself


def equal_sums(transfer: Transfer, takes: AllFields, gives: AllFields) -> list[tuple[str, str]]:
    """Impulses that a transfer reads and fills, whose sums must be equal: pairs of one unit."""
    fields = takes[transfer.taker]
    filled = [key for key in transfer.fills if fields[key].centring == "impulse"]
    pairs: list[tuple[str, str]] = []
    if not transfer.conservative:
        return pairs
    for key in transfer.reads:
        field = gives[transfer.giver][key]
        after = next((other for other in filled if fields[other].unit == field.unit), None)
        if field.centring == "impulse" and after is not None:
            filled.remove(after)
            pairs.append((key, after))
    return pairs


def works(transfers: Sequence[Transfer], takes: AllFields, gives: AllFields) -> dict[str, Works]:
    """Forces that components give over a link, each with the motion that its giver takes.

    Only a position (3,) is named, from which the moment about the origin follows.
    """
    of_giver: dict[str, Works] = {}
    for push in transfers:
        for key in push.reads:
            force = gives[push.giver][key]
            moved = [t.fills for t in transfers if (t.giver, t.taker) == (push.taker, push.giver)]
            for velocity, place in _motion(force, moved, takes[push.giver]):
                vector = place in takes[push.giver] and takes[push.giver][place].shape == (3,)
                named = place if vector and force.unit == "N" else ""
                of_giver.setdefault(push.giver, []).append((key, velocity, named))
    return of_giver


def works_on(
    push: Transfer, transfers: Sequence[Transfer], takes: AllFields, gives: AllFields
) -> Works:
    """Impulses that a taker takes by one transfer, each with the motion that the taker gives."""
    moved = [t.reads for t in transfers if (t.giver, t.taker) == (push.taker, push.giver)]
    return [
        (key, *motion)
        for key in push.fills
        for motion in _motion(takes[push.taker][key], moved, gives[push.taker])
    ]


def _motion(
    force: Field, moved: Sequence[tuple[str, ...]], fields: Mapping[str, Field]
) -> list[tuple[str, str]]:
    """Velocity with which a force works, among what one side takes or gives of the motion.

    With the output of which it is the rate: "" if there is none, INTEGRAL if it is an impulse.
    """
    for keys in moved if force.works_with else ():
        for key in keys:
            port, _, name = key.partition(".")
            if name == force.works_with:
                if fields[key].centring == "impulse":
                    return [(key, INTEGRAL)]
                same_port = [k for k in fields if k.partition(".")[0] == port]
                return [(key, next((k for k in same_port if fields[k].rate == name), ""))]
    return []
