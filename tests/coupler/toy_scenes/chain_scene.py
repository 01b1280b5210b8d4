"""A scene of a chain of masses whose ranks may fail on purpose, and of what pushes them."""

import shutil
from pathlib import Path

TOYS = Path(__file__).with_name("toy_ranks.py")
SCENE = """
name = "chain"
end = {end}
window = 2e-3
patience = 2.0
transport = "{transport}"
[components.chain]
kind = "toy_ranks:Chain"
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


def write(folder, transport, ranks, end=0.2, keys=""):
    folder.mkdir(exist_ok=True)
    shutil.copy(TOYS, folder)
    path = folder / "scene.toml"
    path.write_text(SCENE.format(transport=transport, ranks=ranks, end=end, keys=keys))
    return path
