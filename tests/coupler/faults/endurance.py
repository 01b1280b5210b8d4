"""Memory, descriptors and files of a long run; a command that takes a number of windows.

``python tests/coupler/faults/endurance.py 200000 --transport zenoh --restarts`` runs two small
components, samples all processes of the run, and writes a table and a picture.
"""

import argparse
import json
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

TOYS = Path(__file__).parents[1] / "toy_scenes"
sys.path.insert(0, str(TOYS))
from started import Started, write_scene  # noqa: E402

from quintet.coupler.files.reached import NAME, Reached  # noqa: E402

WINDOW = 1e-3  # s, of the scene
VIEWS = 100  # windows between two views
WARM = 0.5  # share of the windows after which memory must be flat
FILES = {
    "recording.h5": 700.0,
    "ledger.csv": 20.0,
    "pong.vtkhdf": 30.0,
}  # bytes a window, at most, in the second half
SCENE = """
[output]
interval = {interval}
record = {record}
"""
COLUMNS = ("pss", "rss", "anonymous", "descriptors", "threads")


def read_memory(pid):
    """PSS, RSS and anonymous PSS of a process [bytes], its descriptors and its threads."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]
    sizes = {line.split(":")[0]: 1024 * int(line.split()[1]) for line in lines}
    descriptors = len(list(Path(f"/proc/{pid}/fd").iterdir()))
    threads = len(list(Path(f"/proc/{pid}/task").iterdir()))
    return sizes["Pss"], sizes["Rss"], sizes["Pss_Anon"], descriptors, threads


def name_of(pid, first, transport):
    """The role of a process of the run."""
    words = Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")
    program = Path(words[0]).name
    if program.startswith(("mpiexec", "hydra")) or program == "sh":
        return program
    if "--name" in words:
        return words[words.index("--name") + 1]
    if "quintet.coupler.launch.new_session" in words:
        return "session"
    if "--inside-mpi" in words:
        return "coupler"
    if pid != first:
        return "companion"
    return "starter" if transport == "mpi" else "coupler"


class Samples:
    """Samples of all processes of a run, by their names, and of its files."""

    def __init__(self, run, transport):
        self.run, self.transport, self.rows, self.files = run, transport, {}, []
        self._said, self._names = 0, {}
        self._reader = threading.Thread(target=self._read_progress, daemon=True)
        self._reader.start()

    def _read_progress(self):
        for line in self.run.process.stdout:
            for part in line.split(", "):
                if part.startswith("window "):
                    self._said = int(part.split()[1])

    def close(self):
        """End all processes of the run; return its error output."""
        self.run.end()
        errors = self.run.process.stderr.read()
        self._reader.join()
        self.run.process.stdout.close()
        self.run.process.stderr.close()
        return errors

    def windows(self):
        """Windows done."""
        return max(Reached.read(self.run.folder / "log" / NAME)[0], self._said)

    def take(self):
        """Sample everything once."""
        windows = self.windows()
        for pid in self.run.processes():
            try:
                if pid not in self._names:
                    name = name_of(pid, self.run.process.pid, self.transport)
                    self._names[pid] = f"{name} {pid}"
                row = (windows, *read_memory(pid))
            except OSError:  # it has ended meanwhile
                continue
            self.rows.setdefault(self._names[pid], []).append(row)
        sizes = {name: (self.run.folder / name) for name in FILES}
        sizes = {name: path.stat().st_size for name, path in sizes.items() if path.exists()}
        self.files.append({"windows": windows, **sizes})

    def take_all(self, interval, seconds):
        """Sample until the run ends."""
        limit = time.monotonic() + seconds
        while self.run.process.poll() is None:
            assert time.monotonic() < limit, f"not done after {seconds} s: {self.windows()}"
            if self.windows():
                self.take()
            time.sleep(interval)


def half(rows, windows):
    """Samples (n, 6) of the second half of the windows, without those after the last window."""
    rows = np.array(rows, float)
    return rows[(rows[:, 0] >= WARM * windows) & (rows[:, 0] < windows)]


def summary(samples, windows):
    """Growth of each process over the second half of the windows, and of each file."""
    table = {}
    for name, rows in samples.rows.items():
        if rows[-1][0] < 0.9 * windows or rows[0][0] > 0.4 * windows:
            continue  # not there all the time
        late_samples = half(rows, windows)
        slope = np.polyfit(late_samples[:, 0], late_samples[:, 3], 1)[0]
        name = name.rpartition(" ")[0]
        table[f"{name} 2" if name in table else name] = {
            "rss": late_samples[-1, 2],  # bytes, at the end
            "pss": late_samples[-1, 1],
            # bytes of anonymous memory, second half
            "growth": late_samples[-1, 3] - late_samples[0, 3],
            "slope": slope,  # bytes a window
            "descriptors": [int(late_samples[:, 4].min()), int(late_samples[:, 4].max())],
            "threads": [int(late_samples[:, 5].min()), int(late_samples[:, 5].max())],
        }
    late_samples = [row for row in samples.files if row["windows"] >= WARM * windows]
    first, last = late_samples[0], late_samples[-1]
    span = max(1, last["windows"] - first["windows"])
    files = {name: (last[name] - first[name]) / span for name in FILES if name in first}
    return {"windows": windows, "processes": table, "files": files}


def endure(folder, windows, transport, restarts=False, record=True, views=True, interval=0.5):
    """Run a number of windows; return the samples and their summary."""
    keys = "seen = true" if views else ""
    scene = write_scene(folder, transport, WINDOW * windows, keys, keys)
    view_interval = VIEWS * WINDOW if views else 0.0
    output = SCENE.format(interval=view_interval, record=str(record).lower())
    scene.write_text(scene.read_text() + output)
    run = Started(scene, *(["--set", "restarts=3"] if restarts else []))
    samples, start = Samples(run, transport), time.monotonic()
    try:
        samples.take_all(interval, 30.0 + 0.05 * windows)
    finally:
        errors = samples.close()
    assert run.process.wait() == 0, errors
    assert run.results["windows"] == windows
    report = summary(samples, windows) | {"seconds": time.monotonic() - start}
    report |= {"transport": transport, "restarts": restarts, "record": record, "views": views}
    return samples, report


def draw(samples, report, path):
    """Draw memory and descriptors of every process over the windows."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 9.0), layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    for name, rows in samples.rows.items():
        rows = np.array(rows, float)
        if len(rows) > 2:
            panels[0].plot(rows[:, 0], rows[:, 3] / 1e6, label=name.rpartition(" ")[0])
            panels[1].plot(rows[:, 0], rows[:, 4])
    for name in report["files"]:
        points = [row for row in samples.files if name in row]
        sizes = [row[name] / 1e6 for row in points]
        panels[2].plot([row["windows"] for row in points], sizes, label=name)
    labels = ("anonymous memory [MB]", "descriptors", "files [MB]")
    for panel, label in zip(panels, labels, strict=True):
        panel.set(ylabel=label)
        panel.grid(alpha=0.3)
        panel.set_ylim(0.0)
    panels[0].legend(fontsize=8)
    panels[2].legend(fontsize=8)
    panels[2].set(xlabel="windows")
    title_parts = [f"{report['windows']} windows over {report['transport']}"]
    title_parts += [option for option in ("restarts", "record", "views") if report[option]]
    figure.suptitle(", ".join(title_parts))
    figure.savefig(path, dpi=100)


def table(report):
    """One line for each process and file."""
    lines = [f"{report['windows']} windows over {report['transport']} in {report['seconds']:.0f} s"]
    for name, row in report["processes"].items():
        growth = f"{row['growth'] / 1e6:+.2f} MB in the second half, {row['slope']:+.1f} B/window"
        low, high = row["descriptors"]
        lines.append(
            f"{name:20} {row['rss'] / 1e6:7.1f} MB, PSS {row['pss'] / 1e6:6.1f} MB, {growth}, "
            f"{low} to {high} descriptors, {row['threads'][1]} threads"
        )
    lines += [f"{name:20} {size:.0f} B/window" for name, size in report["files"].items()]
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("windows", type=int, nargs="?", default=200_000)
    parser.add_argument("--transport", default="zenoh")
    parser.add_argument("--restarts", action="store_true")
    parser.add_argument("--bare", action="store_true", help="no recording, no views")
    parser.add_argument("--out", type=Path, help="folder for table, numbers and picture")
    options = parser.parse_args()
    outputs = {"record": not options.bare, "views": not options.bare}
    with tempfile.TemporaryDirectory() as place:
        samples, report = endure(
            Path(place), options.windows, options.transport, options.restarts, **outputs
        )
    print(table(report))
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
        stem = f"{options.transport}{'-restarts' if options.restarts else ''}"
        stem += "-bare" if options.bare else ""
        draw(samples, report, options.out / f"{stem}.png")
        (options.out / f"{stem}.json").write_text(json.dumps(report, indent=2))
