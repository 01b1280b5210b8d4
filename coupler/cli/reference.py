"""Commands that start no solver: list, check, describe, materials, schema."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from quintet.coupler.cli.options import IMPORT, Command, add_scene, load_scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import require

GRAPH = "draw components, ports and links instead of the plan"
PICTURE = (
    "also build all components, without a step, and draw what they show from three sides into this "
    "file"
)
MERMAID = "print the graph as a Mermaid flowchart"
SUBJECT = (
    "scene, a kind, or link and its kind; then a table or key of it (default: list all subjects)"
)
WRITE = "write the tables between <!-- describe SUBJECT --> and <!-- described --> in files"


def add_commands(command: Command) -> None:
    """Add what starts no solver."""
    listing = command("list", list_scenes, "list scenes with components, presets and run times")
    listing.add_argument("--json", action="store_true", help="print JSON")
    plan = command("check", check, "check a scene and print its plan, without a run")
    add_scene(plan)
    plan.add_argument("--import", action="store_true", dest="imports", help=IMPORT)
    plan.add_argument("--picture", type=Path, metavar="FILE", help=PICTURE)
    plan.add_argument("--force", action="store_true", help="replace the picture")
    shape = plan.add_mutually_exclusive_group()
    shape.add_argument("--graph", action="store_true", help=GRAPH)
    shape.add_argument("--mermaid", action="store_true", help=MERMAID)
    keys = command("describe", describe, "describe the keys of scenes, kinds and links, with units")
    keys.add_argument("subject", nargs="*", metavar="SUBJECT", help=SUBJECT)
    keys.add_argument("--json", action="store_true", help="print JSON")
    keys.add_argument("--write", nargs="+", type=Path, default=[], metavar="FILE", help=WRITE)
    named = command("materials", materials, "list materials by name, with constants and sources")
    named.add_argument("name", nargs="?", default="", help="print the constants of this material")
    named.add_argument("--json", action="store_true", help="print JSON")
    machine = command("devices", devices, "list OpenCL devices: memory, precision, bandwidth")
    machine.add_argument("--json", action="store_true", help="print JSON")
    editors = command("schema", schema, "print a JSON schema of scene files, for editors")
    editors.add_argument(
        "scene", nargs="?", help="scene whose kinds module:Class the schema includes"
    )
    editors.add_argument("--import", action="store_true", dest="imports", help=IMPORT)


def devices(options: argparse.Namespace) -> int:
    """List the OpenCL devices of this machine, in a process that loads their drivers."""
    program = [sys.executable, "-m", "quintet.components.shared.opencl"]
    return subprocess.run([*program, *(["--json"] if options.json else [])]).returncode


def list_scenes(options: argparse.Namespace) -> int:
    """List the scenes that come with quintet."""
    # Start-up: only this command needs it.
    from quintet.coupler.scene.listing import list_all

    list_all(options.json)
    return 0


def check(options: argparse.Namespace) -> int:
    """Print the plan of a scene, or draw who is linked to whom."""
    scene = load_scene(options)
    # Start-up: only this command needs it.
    from quintet.coupler.scene import graph
    from quintet.coupler.scene.listing import console, print_plan, tell_unread
    from quintet.coupler.scene.needs import require_memory

    require_memory(scene)
    if options.graph or options.mermaid:
        print(graph.mermaid(scene) if options.mermaid else graph.drawing(scene))
        tell_unread(scene)
    else:
        print_plan(scene, console())
    if options.picture:
        _draw_start(options)
    return 0


def _draw_start(options: argparse.Namespace) -> None:
    """Draw what a scene shows at its start, from three sides."""
    # Start-up: only this picture needs it.
    from quintet.coupler.report.free_place import free_place
    from quintet.coupler.report.redraw import FORMATS
    from quintet.coupler.report.three_views import draw_three_views
    from quintet.coupler.run.first_view import write_first_view

    require("matplotlib", "--picture")
    place = free_place(options.picture, options.picture, FORMATS, options.force, "--picture")
    options.transport = "memory"  # nothing travels: all components are built here
    scene = load_scene(options)
    if unread := [c.kind for c in scene.components.values() if c.unread]:
        raise SceneError(
            f"--picture builds all components, and {', '.join(unread)} is code that check does not "
            "import by itself. Add --import."
        )
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SceneError(
            f"--picture {place}: it must lie in a folder; {error.filename} is none "
            f"({error.strerror}). Name another file."
        ) from error
    with tempfile.TemporaryDirectory() as folder:
        if not write_first_view(scene, Path(folder)):
            print("quintet: no picture: no component has anything to show.", flush=True)
            return
        colours = tuple(scene.file.output.colours)
        draw_three_views(Path(folder), place, colours, f"{scene.headline} at the start")
    print(f"picture: {place}", flush=True)


def describe(options: argparse.Namespace) -> int:
    """Print what a scene, a kind or a link may say."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.describe import run_describe

    return run_describe(options)


def materials(options: argparse.Namespace) -> int:
    """List materials, or print the constants of one."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.materials import print_materials

    print_materials(options.name, options.json)
    return 0


def schema(options: argparse.Namespace) -> int:
    """Print the JSON schema of scene files."""
    # Start-up: only this command needs it.
    from quintet.coupler.reference.schema import as_text, scene_schema
    from quintet.coupler.scene.listing import tell_unread
    from quintet.coupler.scene.read import load

    scene = load(options.scene, imports=options.imports) if options.scene else None
    plans = scene.components.values() if scene else ()
    kinds = [plan.kind for plan in plans if not plan.unread]
    if scene:
        tell_unread(scene)
    print(as_text(scene_schema(kinds)))
    return 0
