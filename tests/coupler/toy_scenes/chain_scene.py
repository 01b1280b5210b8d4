"""A scene of a chain of masses that several ranks share, and of a component that pushes it."""

import shutil
from pathlib import Path

NAMES = ("toys.py", "toy_ranks.py", "toy_faults.py", "toy_rank_faults.py")
TOYS = [Path(__file__).with_name(name) for name in NAMES]
CHAIN = "toy_ranks:Chain"
SCENE = """
name = "chain"
end = {end}
window = 2e-3
patience = {patience}
transport = "{transport}"
[components.chain]
kind = "{kind}"
ranks = {ranks}
{keys}
[components.pusher]
kind = "toy_ranks:Pusher"
[[links]]
kind = "direct"
pairs = [["chain.motion", "pusher.motion"], ["pusher.push", "chain.push"]]
[output]
snapshots = 0.05
"""


def write(folder, transport, ranks, end=0.2, keys="", kind=CHAIN, patience=2.0):
    folder.mkdir(exist_ok=True, parents=True)
    for path in TOYS:
        shutil.copy(path, folder)
    path = folder / "scene.toml"
    values = {"transport": transport, "ranks": ranks, "end": end, "keys": keys, "kind": kind}
    path.write_text(SCENE.format(**values, patience=patience))
    return path
