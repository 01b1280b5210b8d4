"""Saving and loading; terms that are off are neither imported nor compiled."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Fields, outputs_of

Make = Callable[..., SphFluid]
Join = Callable[..., Fields]

CONTINUE = """
import sys
import numpy as np
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.params import Boundary

saved = dict(np.load(sys.argv[1]))
from quintet.components.sph_fluid.setup.shapes import FluidRegion
region = FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.12, 0.12, 0.12))
dbc = Boundary(method="dbc")
fluid = SphFluid(SphFluidParams(spacing=0.02, sound_speed=20.0, fluid=(region,), boundary=dbc))
position, velocity = saved.pop("position"), saved.pop("velocity")
rows = len(position)
volume, body = np.full(rows, 0.02**3), np.zeros(rows)
joined = {"surface.normal": velocity, "surface.volume": volume, "surface.body": body}
fluid.bind(joined, {"surface"})
fluid.load(saved)
for _ in range(25):
    fluid.take({"surface.position": position, "surface.velocity": velocity})
    fluid.step(fluid.stable_dt())
np.savez(sys.argv[1], **fluid.save())
"""

LOOK = """
import sys, numpy as np
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid import kernels
from quintet.components.sph_fluid.pairs import kernels as pair_kernels
from quintet.components.sph_fluid.params import Boundary
from quintet.components.sph_fluid.setup.shapes import FluidRegion
region = FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.12, 0.12, 0.12))
dbc = Boundary(method="dbc")
fluid = SphFluid(SphFluidParams(spacing=0.02, sound_speed=20.0, fluid=(region,), boundary=dbc))
fluid.step(fluid.stable_dt())
loaded = {name.rpartition(".")[2] for name in sys.modules if "sph_fluid" in name}
left_out = "shepard_filter contact_potential potential acoustic_damper mirrored mirrored_density"
left_out += " single_precision position_verlet symmetry lubrication film_geometry gauges"
left_out += " film_search selective_films nearby_bodies removal shape_filling field_table"
assert not loaded & set(left_out.split()), loaded
assert not pair_kernels.sample_forces.signatures
(signature,) = kernels.pair_rates.signatures
law = dict(zip(signature[6].fields, signature[6].types))
assert str(law["damper"]) == "none"
for name in ("fluid", "boundary"):
    terms = dict(zip(law[name].fields, law[name].types))
    switches = [terms["volume"], terms["xsph"]]
    for term in ("viscosity", "diffusion", "repulsion", "contact"):
        switches.append(dict(zip(terms[term].fields, terms[term].types))["on"])
    assert [str(one) for one in switches] == ["none"] * 6, terms
assert fluid.pairs.rates.xsph_velocity.size == fluid.state.force.size == 0
"""

MIRRORED = """
import sys, numpy as np
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid import kernels
from quintet.components.sph_fluid.pairs import kernels as pair_kernels
from quintet.components.sph_fluid.params import Boundary
from quintet.components.sph_fluid.setup.shapes import FluidRegion
region = FluidRegion(lowest=(0.0, 0.0, 0.0), highest=(0.12, 0.12, 0.12))
mdbc = Boundary(method="mdbc")
fluid = SphFluid(SphFluidParams(spacing=0.02, sound_speed=20.0, fluid=(region,), boundary=mdbc))
one = np.array([[0.06, 0.06, -0.01]])
static = {"normal": one, "volume": np.full(1, 8e-6), "body": np.zeros(1), "contact": np.zeros(1)}
fluid.bind({f"surface.{key}": array for key, array in static.items()}, {"surface"})
moved = {"position": one, "velocity": 0.0 * one, "mirror": one + (0.0, 0.0, 0.02)}
fluid.take({f"surface.{key}": array for key, array in moved.items()})
fluid.step(fluid.stable_dt())
assert not [name for name in sys.modules if name.endswith(".contact_potential")]
(signature,) = pair_kernels.sample_forces.signatures
law = dict(zip(signature[8].fields, signature[8].types))
terms = dict(zip(law["boundary"].fields, law["boundary"].types))
assert str(terms["contact"].types[0]) == "none", terms
"""


LIGHT = """
import sys
import quintet.components.sph_fluid as kind
from quintet.interfaces.manifest import find

assert find("sph_fluid") is kind.MANIFEST
assert "numba" not in sys.modules
"""


def python(text: str, *arguments: str) -> None:
    subprocess.run([sys.executable, "-c", text, *arguments], check=True)


def test_saved_state_continues_with_the_same_bits_in_a_fresh_process(
    drop: Make, plate: Join, tmp_path: Path
) -> None:
    fluid = drop()
    fields = plate(fluid)
    fluid.take(fields)
    for _ in range(35):
        fluid.step(fluid.stable_dt())
    file = tmp_path / "state.npz"
    position, velocity = fields["surface.position"], fields["surface.velocity"]
    np.savez(file, **fluid.save(), position=position, velocity=velocity)
    python(CONTINUE, str(file))
    for _ in range(25):
        fluid.take(fields)
        fluid.step(fluid.stable_dt())
    same_process, fresh_process = fluid.save(), dict(np.load(file))
    assert same_process.keys() == fresh_process.keys()
    assert all(np.array_equal(same_process[name], fresh_process[name]) for name in same_process)


def test_repeated_window_gives_the_same_bits(pool: Make) -> None:
    fluid = pool(xsph=0.5, shepard_every=5)
    for _ in range(12):
        fluid.step(fluid.stable_dt())
    saved = fluid.save()
    ends = []
    for _ in range(2):
        fluid.load(saved)
        for _ in range(12):
            fluid.step(fluid.stable_dt())
        ends.append(fluid.save())
    assert all(np.array_equal(ends[0][name], ends[1][name]) for name in saved)


def test_what_goes_out_is_a_copy(drop: Make, plate: Join) -> None:
    fluid = drop()
    fluid.take(plate(fluid))
    fluid.step(1e-4)
    saved = {name: array.copy() for name, array in fluid.save().items()}
    for fields in (outputs_of(fluid), fluid.view(), fluid.save()):
        for array in fields.values():
            array[...] = 7
    assert all(np.array_equal(saved[name], array) for name, array in fluid.save().items())


def test_samples_keep_the_order_of_their_port(drop: Make, plate: Join) -> None:
    fluid = drop()
    fields = plate(fluid)
    fluid.take(fields)
    fluid.step(1e-4)
    assert np.array_equal(
        fluid.state.position_density[fluid.samples.row, :3], fields["surface.position"]
    )
    assert len(outputs_of(fluid)["surface_load.force"]) == len(fields["surface.position"])


def test_particles_are_shown_in_the_order_of_their_birth(pool: Make) -> None:
    fluid = pool()
    before = fluid.view()["points"]
    for _ in range(3):
        fluid.step(fluid.stable_dt())
    assert np.abs(fluid.view()["points"] - before).max() < 1e-3


@pytest.mark.parametrize("scene", [LOOK, MIRRORED])
def test_terms_that_are_off_are_not_compiled(scene: str) -> None:
    python(scene)


def test_manifest_is_light() -> None:
    python(LIGHT)
