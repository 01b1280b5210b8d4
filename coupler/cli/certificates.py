"""Command that makes certificates for a run over several hosts: certificates."""

import argparse
import datetime
import json
import shlex
from pathlib import Path

from quintet.coupler.cli.options import Command, add_scene, load_scene

HOSTS = (
    "hosts of a component or of the coupler, as in --hosts coupler=node1,10.0.0.1; may be "
    "repeated; beside this host for the coupler, and the loopback"
)
LONGEST = 3650  # days


def add_commands(command: Command) -> None:
    """Add what makes certificates."""
    making = command(
        "certificates", certificates, "make an authority and certificates for a run over tls"
    )
    add_scene(making)
    making.add_argument("--hosts", action="append", default=[], metavar="NAME=HOST,...", help=HOSTS)
    making.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for them")
    making.add_argument(
        "--days", type=_days, default=90, help="for which they are valid (default: 90)"
    )


def _days(text: str) -> int:
    value = int(text) if text.isdecimal() else 0
    if not 1 <= value <= LONGEST:
        raise argparse.ArgumentTypeError(
            f"must be a whole number from 1 to {LONGEST}; found {text!r}"
        )
    return value


def certificates(options: argparse.Namespace) -> int:
    """Make them, and say how they are used."""
    # Start-up: only this command needs it.
    from quintet.coupler.launch import certificates as making

    scene = load_scene(options)
    names = list(scene.components)
    hosts = making.hosts_of(options.hosts, names, scene.endpoint)
    making.write_certificates(options.out, hosts, options.days)
    end = datetime.date.today() + datetime.timedelta(days=options.days)
    endpoint = scene.endpoint if scene.endpoint.startswith("tls/") else "tls/HOST:7447"
    tls = json.dumps(making.files_of(options.out, making.COUPLER))
    asked = [options.scene, *(["--preset", options.preset] if options.preset else [])]
    started = ["run", *asked, "--elsewhere", names[0], "--set", f"tls={tls}"]
    started += ["--set", f'endpoint="{endpoint}"']
    files = making.files_of(options.out, names[0])
    joined = ["join", *asked, names[0], "--at", endpoint, "--tls", *files]
    print(
        f"{options.out}: an authority, and certificates for {', '.join(hosts)}, valid until {end} "
        f"({options.days} days).\n"
        f"The run:       quintet {shlex.join(started)}\n"
        f"A component:   quintet {shlex.join(joined)}\n"
        "Copy to the host of a component authority.pem and the two files of its name only. The "
        f"coupler admits a component only with the certificate of its name. Anyone who has "
        "authority.key can make further ones: keep it away from other hosts, or delete it."
    )
    return 0
