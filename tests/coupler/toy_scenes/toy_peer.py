"""A program beside the scene of a spring: it prints its times and writes an exact curve."""

from spring_scene import write

REFINEMENTS = """
[[study]]
label = "0.02"
settings = { "components.spring.step" = 0.02 }
size = "components.spring.step"
[[study]]
label = "0.01"
settings = { "components.spring.step" = 0.01 }
size = "components.spring.step"
"""
PROGRAM = """
import math, sys, time
phase = float(sys.argv[1])
print("Version 7.1", flush=True)
print("seconds 0.25", flush=True)
print("seconds 0.75", flush=True)
with open("curve.txt", "w") as file:
    file.write("time position\\n")
    for k in range(101):
        file.write(f"{k / 100} {math.cos(10.0 * k / 100 + phase)}\\n")
open("large", "w").write("left behind")
{more}
"""
CPU = """[cpu]
seconds = 'seconds (\\S+)'
repeats = "clock"
"""
TABLE = """
program = "Toy"
command = ["@python@", "toy.py", "@phase@"]
install = "pip install toy"
version = 'Version (\\S+)'
settings = "exact, but for its phase"
source = "written for this test"
inputs = { "toy.py" = "toy.txt" }
minutes = 1
[cpu]
seconds = 'seconds (\\S+)'
repeats = "clock"
[[curve]]
component = "spring"
field = "motion.position"
axis = 0
file = "curve.txt"
[[run]]
label = "late"
values = { phase = 0.01 }
[[run]]
label = "later"
values = { phase = 0.02 }
[[run]]
label = "latest"
values = { phase = 0.04 }
"""


def write_peer(folder, change=("", ""), more=""):
    """A scene with refinements, and a program beside it."""
    folder.mkdir(exist_ok=True)
    path = write(folder, REFINEMENTS)
    place = folder / "peers" / "toy"
    place.mkdir(parents=True)
    (place / "toy.txt").write_text(PROGRAM.replace("{more}", more))
    assert change[0] in TABLE
    (place / "peer.toml").write_text(TABLE.replace(*change) if change[0] else TABLE)
    return path
