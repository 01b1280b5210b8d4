"""Driven bodies of a scene, whose places and sizes are those of the partner's bodies."""

from typing import Any

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError

Table = dict[str, Any]


def complete(keys: Table, partners: Fields) -> Table:
    """Table of a gas whose driven bodies have the centres and radii of the partner's bodies.

    Parameters
    ----------
    keys
        Table of a scene, not checked.
    partners
        What the partner states at the start: ``motion.position`` (d, 3) m, ``motion.radius`` (d,)
        m. Bodies whose places are not stated keep those of the table.
    """
    places, radii = partners.get("motion.position"), partners.get("motion.radius")
    moving: Any = keys.get("moving")
    bodies = moving.get("bodies") if isinstance(moving, dict) else None
    if places is None or not isinstance(bodies, list):
        return keys
    rows = [k for k, body in enumerate(bodies) if isinstance(body, dict) and body.get("is_driven")]
    if len(places) != len(rows):
        raise SceneError(
            f"moving.bodies: each driven body needs a partner; found {len(rows)} driven bodies and "
            f"{len(places)} of the partner. Give both as many."
        )
    bodies = list(bodies)
    for row, k in enumerate(rows):
        if "centre" in bodies[k]:
            raise SceneError(
                f"moving.bodies.{k}.centre: a driven body begins where its partner has it, at "
                f"{places[row].tolist()} m; found {bodies[k]['centre']} m. Leave it out."
            )
        size = {} if radii is None else {"radius": float(radii[row])}
        bodies[k] = size | bodies[k] | {"centre": places[row].tolist()}
    return keys | {"moving": moving | {"bodies": bodies}}
