"""What bodies of particles take and give: glue to a mesh; motion of each body; gauges."""

from dataclasses import replace

from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    CONTACT_ACTIVITY,
    CONTACT_FACES,
    CONTACT_LOAD,
    GLUE_ACTIVITY,
    GLUED,
    GLUED_LOAD,
    PLANAR_CONTACT_FACES,
    POSITION,
    TEMPERATURE,
    VELOCITY,
)

# Of the view, at particles.
SHOWS = (
    Field("von_mises", (), "Pa"),
    VELOCITY,
    Field("pressure", (), "Pa"),
    Field("plastic_strain", (), "1"),
    Field("damage", (), "1"),  # 1 once it has failed
    TEMPERATURE,
    Field("body", (), "1"),
)
# Of each body, in the order of the scene: of what is computed, without images.
UNGLUED = "it has no table glued"  # where a link needs glued particles
UNTOUCHED = "set contact_with_faces = true"  # where a link needs contact with faces
BODIES = Port(
    "bodies",
    fields=(
        POSITION,  # centre of mass
        VELOCITY,  # of it
        Field("kinetic", (), "J"),
        Field("internal", (), "J"),
        Field("failed", (), "1"),  # share of its mass that has failed
        Field("lowest", (3,), "m"),  # corners of what it reaches over, cells of its particles
        Field("highest", (3,), "m"),
    ),
)
# Of the particle nearest to each gauge at the start.
GAUGES = Port(
    "gauges",
    fields=(
        POSITION,
        VELOCITY,
        Field("stress", (3,), "Pa"),  # normal components xx, yy, zz; tension is positive
        Field("pressure", (), "Pa"),
        Field("von_mises", (), "Pa"),
        Field("density", (), "kg/m3"),
        Field("plastic_strain", (), "1"),
        Field("failed", (), "1"),
        TEMPERATURE,
    ),
)


# Along lines through bodies: ends of what has not failed, at its particles.
LEVELS = Port(
    "levels",
    fields=(Field("highest", (), "m"), Field("lowest", (), "m")),
)


def ports(params: SphSolidParams) -> Ports:
    """Ports taken and given.

    Glued particles say the force that they bear at the present time, and move with what they are
    told for the coming step: over a mesh of the same steps this is one leapfrog.
    """
    glued = len(params.glued) > 0
    taken: tuple[Port, ...] = (GLUED, GLUE_ACTIVITY) if glued else ()
    load: tuple[Port, ...] = (GLUED_LOAD,) if glued else ()
    if params.contact_with_faces:
        faces = PLANAR_CONTACT_FACES if params.dimensions == 2 else CONTACT_FACES
        taken, load = (*taken, faces, CONTACT_ACTIVITY), (*load, CONTACT_LOAD)
    lacking: tuple[tuple[str, str], ...] = () if glued else ((GLUED_LOAD.name, UNGLUED),)
    lacking += () if params.contact_with_faces else ((CONTACT_FACES.name, UNTOUCHED),)
    read = (*((GAUGES,) if params.gauges else ()), *((LEVELS,) if params.levels else ()))
    bodies = replace(BODIES, lacks=lacking) if lacking else BODIES
    return taken, (bodies, *load, *read)
