"""Response of the hull by linear potential theory: ``python scenarios/hull_in_waves/response.py``.

It prints heave over the amplitude of the waves and pitch over their slope, of the hull free in
surge, heave and pitch in waves along it, on water of the flume's depth, by the boundary element
method of Capytaine (Ancellin & Dias, J. Open Source Softw. 4 (2019) 1341), which quintet does not
need: ``pip install capytaine==3.0.0``. Hulls in a row across the waves stand for images in walls.
"""

import math
import sys
from pathlib import Path

import numpy as np
import trimesh

DEPTH, PERIOD, WIDTH = 0.42, 1.4, 0.48  # m, s, m
GRAVITY = 9.81  # m/s2
FILE = Path(__file__).parents[1] / "floating_hull" / "hull.stl"
WATERLINE = -0.0562  # m, in the file: 0.1038 m above the keel (floating_hull/hull.py)
DENSITY, WATER = 550.0, 1000.0  # kg/m3
DOFS = ("Surge", "Heave", "Pitch")


def wave_number(omega: float, depth: float = DEPTH) -> float:
    """Wave number [1/m]: ω² = g k tanh(k h), by bisection."""
    low, high = 0.0, 1000.0
    for _ in range(100):
        k = 0.5 * (low + high)
        low, high = (k, high) if GRAVITY * k * math.tanh(k * depth) < omega * omega else (low, k)
    return low


def response(hulls: int, period: float = PERIOD) -> dict[str, float]:
    """Amplitudes, m/m and rad/m, of the motion of each of a row of hulls that move as one."""
    import capytaine as cpt  # of this script alone

    hull = trimesh.load_mesh(FILE)
    points = hull.vertices - [0.0, 0.0, WATERLINE]
    quads = np.column_stack([hull.faces, hull.faces[:, 0]])
    row = [
        cpt.Mesh(vertices=points + np.array([0.0, k * WIDTH, 0.0]), faces=quads)
        for k in range(-(hulls // 2), hulls // 2 + 1)
    ]
    mesh = row[0].join_meshes(*row[1:]) if hulls > 1 else row[0]
    centre = (0.0, 0.0, float(hull.center_mass[2]) - WATERLINE)
    body = cpt.FloatingBody(
        mesh=mesh.immersed_part(),
        dofs=cpt.rigid_body_dofs(only=DOFS, rotation_center=centre),
        center_of_mass=centre,
    )
    omega = 2.0 * math.pi / period
    sea = {"body": body, "omega": omega, "water_depth": DEPTH, "rho": WATER, "g": GRAVITY}
    problems = [cpt.DiffractionProblem(wave_direction=0.0, **sea)]
    problems += [cpt.RadiationProblem(radiating_dof=dof, **sea) for dof in body.dofs]
    waves = cpt.assemble_dataset(cpt.BEMSolver().solve_all(problems))
    mass, inertia = DENSITY * hull.volume, DENSITY * hull.moment_inertia[1, 1]
    inertias = hulls * np.diag([mass, mass, inertia])
    order = {"influenced_dof": list(DOFS), "radiating_dof": list(DOFS)}
    stiffness = body.compute_hydrostatic_stiffness(rho=WATER, g=GRAVITY).sel(order).values
    added = waves.added_mass.sel(order).values.squeeze()
    damping = waves.radiation_damping.sel(order).values.squeeze()
    force = waves.Froude_Krylov_force + waves.diffraction_force
    load = force.sel(influenced_dof=list(DOFS)).values.squeeze()
    impedance = stiffness - omega**2 * (inertias + added) - 1j * omega * damping
    return dict(zip(DOFS, np.abs(np.linalg.solve(impedance, load)).tolist(), strict=True))


def main() -> None:
    """Print them, of one hull in open water and of rows of 3 and 7."""
    k = wave_number(2.0 * math.pi / PERIOD)
    sys.stdout.write(f"wave length {2.0 * math.pi / k:.5g} m, k = {k:.5g} 1/m\n")
    for hulls in (1, 3, 7):
        motion = response(hulls)
        sys.stdout.write(
            f"{hulls} hulls: surge {motion['Surge']:.4f}, heave {motion['Heave']:.4f}, "
            f"pitch over slope {motion['Pitch'] / k:.4f}\n"
        )


if __name__ == "__main__":
    main()
