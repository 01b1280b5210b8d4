"""Two examples of each command, at the end of its help."""

EXAMPLES = {
    "list": ("quintet list", "quintet list --json"),
    "check": (
        "quintet check dam_break_cubes --preset quick",
        "quintet check splash.toml --set components.water.spacing='20 mm' --graph",
    ),
    "describe": ("quintet describe sph_fluid boundary", "quintet describe link fsi"),
    "materials": ("quintet materials", "quintet materials steel-4340"),
    "devices": ("quintet devices", "quintet devices --json"),
    "schema": ("quintet schema > scene.schema.json", "quintet schema two_springs --import"),
    "new": ("quintet new scene first_try", "quintet new component my_solver --out solver"),
    "run": (
        "quintet run dam_break_cubes --preset quick --out runs/cubes",
        "quintet run splash.toml --set end='0.2 s' --transport memory",
    ),
    "join": (
        "quintet join dam_break_cubes cubes --at tcp/127.0.0.1:7447",
        "quintet join scene.toml water --at tls/node2:7447 --tls ca.pem cert.pem key.pem",
    ),
    "compile": ("quintet compile", "quintet compile dam_break_cubes fe_plate"),
    "show": ("quintet show runs/two_springs", "quintet show runs/two_springs --json"),
    "diff": (
        "quintet diff runs/two_springs runs/two_springs-2",
        "quintet diff runs/over_zenoh runs/over_mpi",
    ),
    "draw": (
        "quintet draw runs/dam_break_cubes --times 0.5,1.0 --colour water.speed",
        "quintet draw runs/two_springs --series upper.motion.position",
    ),
    "report": ("quintet report runs/two_springs", "quintet report runs/cubes --out cubes.html"),
    "export": (
        "quintet export runs/two_springs",
        "quintet export runs/two_springs upper.motion.position --out tables",
    ),
    "trace": ("quintet trace runs/two_springs", "quintet trace runs/cubes --out cubes.json"),
    "debug": (
        "quintet debug runs/cubes --component water",
        "quintet debug runs/cubes --component water --window 12 --stop take",
    ),
    "launch": (
        "quintet launch dam_break_cubes --slurm --nodes 2 --time 02:00:00",
        "quintet launch scene.toml --slurm --image quintet.sif --submit",
    ),
    "certificates": (
        "quintet certificates dam_break_cubes --hosts water=node2 --out certificates",
        "quintet certificates scene.toml --hosts coupler=10.0.0.1,node1 --out certificates",
    ),
    "study": (
        "quintet study two_springs --json study.json",
        "quintet study dam_break_front --beside lammps",
    ),
    "stability": (
        "quintet stability elastic_gate --preset quick",
        "quintet stability plate_modes --json limits.json",
    ),
    "scan": ("quintet scan two_springs", "quintet scan --all --quick"),
    "sweep": (
        "quintet sweep two_springs --over window=0.002,0.004,0.008",
        "quintet sweep scene.toml --over components.water.spacing=0.03,0.02 --jobs 4",
    ),
    "ensemble": (
        "quintet ensemble elastic_gate --runs 16",
        "quintet ensemble dam_break_cubes --preset quick --seed 7",
    ),
    "calibrate": (
        "quintet calibrate two_springs --over components.lower.stiffness=90:110 --to lower.end",
        "quintet calibrate cubes.toml --over components.cubes.pairs.0.friction=0.1:0.4 --to top_x",
    ),
    "controls": (
        "quintet controls two_springs",
        "quintet controls --all --json scenarios/controls.json",
    ),
    "bench": ("quintet bench sph_fluid --threads 2", "quintet bench exchange --transport zenoh"),
    "conform": (
        "quintet conform dem_bodies",
        "quintet conform springs:Mass --scene two_springs --component lower",
    ),
    "scaling": (
        "quintet scaling bench.json --on 64 --items 1e7",
        "quintet scaling bench.json --plot efficiency.png",
    ),
}


def text_of(command: str) -> str:
    """Write the examples of a command as its help ends."""
    return "\n".join(["examples:", *(f"  {line}" for line in EXAMPLES[command])])
