"""A wrong scene never starts: each mistake is a sentence with the place, the rule and the value."""

# ruff: noqa: E501  (a mistake a line)

import platform
import subprocess

import pytest
from started import write_scene

from quintet.coupler.cli import main
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

PAIRS = 'pairs = [["ping.out", "pong.in"], ["pong.out", "ping.in"]]'
EXPECT = """
[[expect]]
name = "e"
component = "pong"
field = "out.number"
axis = 0
measure = "at"
begin = 0.5
value = 1.0
within = 0.1
unit = "m"
source = "none"
"""


@pytest.fixture(autouse=True)
def no_process(monkeypatch):
    platform.processor()  # kept from then on; h5py asks for it, and the system is asked by a process

    def refuse(*arguments, **settings):
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess.Popen, "__init__", refuse)


@pytest.fixture
def scene(tmp_path):
    def write(*changes, more=""):
        path = write_scene(tmp_path)
        text = path.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        path.write_text(text + more)
        return path

    return write


def mistakes_of(path, capsys, *arguments):
    """The messages about a wrong scene; the command leaves no file and ends with status 2."""
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(path), "--out", str(path.parent / "out"), *arguments])
    assert exit_info.value.code == 2
    assert not (path.parent / "out").exists()
    lines = capsys.readouterr().err.splitlines()
    assert all(line.startswith("quintet: ") for line in lines)
    return [line.removeprefix("quintet: scene.toml: ") for line in lines]


WRONG = {
    "syntax": ("end = 1.0", "end = = 1.0", "a scene must be valid TOML: Invalid value (at line 3"),
    "top-level key": ("end = 1.0", "end = 1.0\nwindws = 1", "scene.windws is not known. Did you mean window?"),
    "table": ("[[links]]", "[[link]]", "scene.link is not known. Did you mean links?"),
    "component key": ("[components.pong]", "[components.pong]\npuase = 1.0", "components.pong.puase is not known. Did you mean pause?"),
    "nested key": ("[components.ping]", "[output]\ninterva = 1.0\n[components.ping]", "scene.output.interva is not known. Did you mean interval?"),
    "colours": ("[components.ping]", '[output]\ncolours = ["ping.speed"]\n[components.ping]', "output.colours: ping.speed is not known. Known here: nothing."),
    "region": ("[components.ping]", "[output]\nregion = [[0, 0, 1], [1, 1, 0]]\n[components.ping]", "scene.output.region must be the lowest and the highest corner of a box; found ((0.0, 0.0, 1.0), (1.0, 1.0, 0.0)). Correct it."),
    "missing end": ("end = 1.0", "", "scene.end is needed. Add end to it."),
    "missing name": ('name = "toy"', "", "scene.name is needed. Add name to it."),
    "text for a number": ("end = 1.0", 'end = "1.0"', "scene.end should be a valid number; found '1.0'. Write it without quotes, or, if its key has a unit,"),
    "negative": ("end = 1.0", "end = -1.0", "scene.end should be greater than 0; found -1.0. Correct it."),
    "nan": ("end = 1.0", "end = nan", "scene.end should be a finite number; found nan. Correct it."),
    "infinite": ("end = 1.0", "end = inf", "scene.end should be a finite number; found inf. Correct it."),
    "truth for a number": ("[components.pong]", "[components.pong]\nitems = true", "components.pong.items should be a valid integer; found True. Correct it."),
    "date": ("[components.pong]", "[components.pong]\nitems = 2020-01-01", "components.pong: Object of type date is not JSON serializable. Use numbers, text, lists and tables only."),
    "scheme": ("end = 1.0", 'end = 1.0\nscheme = "seriel"', "scene.scheme should be 'serial', 'parallel' or 'iterated'; found 'seriel'. Correct it."),
    "transport": ('transport = "memory"', 'transport = "pigeon"', "scene.transport should be 'memory', 'zenoh' or 'mpi'; found 'pigeon'. Correct it."),
    "kind": ("toys:Toy", "ehco", "components.ping.kind ehco is not known. Did you mean echo?"),
    "no kind": ('kind = "toys:Toy"', "", "components.ping.kind must be a name; found None. Known here: "),
    "module": ("toys:Toy", "toyz:Toy", "components.ping.kind toyz:Toy cannot be imported (ModuleNotFoundError: No module named 'toyz'). Name a module:Class."),
    "class": ("toys:Toy", "toys:Tony", "components.ping.kind toys:Tony cannot be imported (AttributeError: module 'toys' has no attribute 'Tony'). Name a module:Class."),
    "no component": ("toys:Toy", "toys:Plain", "components.ping.kind toys:Plain: <class 'toys.Plain'> is not a Component. Derive it from Component."),
    "no params": ("toys:Toy", "toys:Bare", "components.ping.kind toys:Bare: a component class must have a Params dataclass; Bare has none. Write `@parameters class Params` inside it."),
    "threads": ("[components.pong]", "[components.pong]\nthreads = 0", "components.pong.threads should be greater than or equal to 1; found 0."),
    "threads text": ("[components.pong]", '[components.pong]\nthreads = "2"', "components.pong.threads should be a valid integer; found '2'. Write it without quotes."),
    "component name": ("[components.pong]", '[components."po/ng"]', "components: a name must be letters, digits, _ or -, and not coupler; found 'po/ng'. Rename it."),
    "component no table": ("[components.ping]", "[components]\npang = 3\n[components.ping]", "components.pang must be a table; found 3. Give it a kind."),
    "link kind": ('kind = "direct"', 'kind = "drect"', "links.0.kind drect is not known. Did you mean direct?"),
    "link no table": ("[[links]]", "[links]", "links must be a list of tables; found {"),
    "link key": ('kind = "direct"', 'kind = "direct"\nbetwen = 1', "links.0.betwen is not known. Known here: kind, name, pairs."),
    "link component": ('"pong.in"', '"peng.in"', "link ping-peng-pong: component peng is not known. Did you mean pong?"),
    "link port": ('"pong.in"', '"pong.inn"', "link ping-pong: pong takes in; found pong.inn. Name one of these."),
    "link direction": ('["ping.out", "pong.in"]', '["ping.in", "pong.out"]', "link ping-pong: ping gives out; found ping.in. Name one of these."),
    "link pairs": (PAIRS, 'pairs = [["ping.out"]]', "links.0.pairs must be pairs of ports, the giver first"),
    "link that does not fit": (f'kind = "direct"\n{PAIRS}', 'kind = "fsi"\nbetween = ["ping", "pong"]', "link ping-pong: fsi needs a component that takes surface and gives surface_load"),
    "link of numbers": (f'kind = "direct"\n{PAIRS}', 'kind = "glue"\nbetween = [["ping"], 2]', "links.0: components and ports are names; found [[['ping'], 2], []]."),
    "link of one": (f'kind = "direct"\n{PAIRS}', 'kind = "glue"\nbetween = ["ping", "ping"]', "links.0.between must name two components; found ['ping', 'ping']."),
    "unit": ("toys:Toy", "toys:InSeconds", "link ping-pong: pong.in.number is in m, the other side's in s. Change one of the ports."),
    "centring": ("toys:Toy", "toys:Instant", "link ping-pong: pong.in.push is impulse, the other side's instant. Change one of the ports."),
    "shape": ("toys:Toy", "toys:Scalar", "link ping-pong: pong.in.number has shape (3,), the other side's (). Change one of the ports."),
    "field": ("toys:Toy", "toys:Unknown", "link ping-pong: pong.in.number is not known to the other side (heat). Change one of the ports."),
    "window": ("window = 1e-3", "window = 2.0", "scene.window must not exceed scene.end (1 s); found 2 s. Shorten it."),
    "window word": ("window = 1e-3", 'window = "automatic"', "scene.window should be a valid number or 'auto'; found 'automatic'. Correct it."),
    "window 0": ("window = 1e-3", "window = 0.0", "scene.window should be greater than 0 or 'auto'; found 0.0. Correct it."),
    "order": ("end = 1.0", 'end = 1.0\norder = ["ping"]', "scene.order must name every component and group once (ping, pong); found ping."),
    "order twice": ("end = 1.0", 'end = 1.0\norder = ["ping", "ping"]', "scene.order must name every component and group once (ping, pong); found ping, ping."),
    "tls": ("end = 1.0", 'end = 1.0\ntls = ["a", "b"]', "scene.tls must be three files: authority, certificate, key; found 2. Name all three."),
    "tls files": ("end = 1.0", 'end = 1.0\ntls = ["a.pem", "b.pem", "c.pem"]', "scene.tls: b.pem is not there. Make the file, or correct its path."),
    "endpoint": ("end = 1.0", 'end = 1.0\nendpoint = "tcp/0.0.0.0:7447"', "scene.endpoint 'tcp/0.0.0.0:7447': off the loopback only tls with certificates on both sides is allowed. Use tls/HOST:PORT and give authority, certificate and key."),
    "endpoint form": ("end = 1.0", 'end = 1.0\nendpoint = "udp/127.0.0.1:7447"', "scene.endpoint 'udp/127.0.0.1:7447': must be tcp/HOST:PORT on the loopback or tls/HOST:PORT."),
    "endpoint tls": ("end = 1.0", 'end = 1.0\nendpoint = "tls/localhost:7447"', "scene.endpoint 'tls/localhost:7447': tls needs authority, certificate and key."),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_scene_is_refused(scene, capsys, case):
    old, new, words = WRONG[case]
    lines = mistakes_of(scene((old, new)), capsys)
    assert any(line.startswith(words) for line in lines), lines
    assert len(lines) == len(set(lines))


EXPECTATIONS = {
    "component": ('"pong"', '"peng"', "expectation e: component peng is not known. Did you mean pong?"),
    "field": ('"out.number"', '"out.numbre"', "expectation e: field pong.out.numbre is not known. Did you mean out.number?"),
    "axis": ("axis = 0", "axis = 3", "expectation e: axis of out.number must be 0 to 2; found 3."),
    "csv": ("value = 1.0", 'csv = "none.csv"', "expectation e: reference none.csv must be a text file beside the scene; "),
    "no reference": ("value = 1.0", "", "expect.e: expectation e: it must have one reference; give either value or csv."),
    "measure": ('"at"', '"around"', "expect.e.measure should be 'rms', 'relative_rms', 'crossing', 'at', 'max', 'min', 'mean', 'integral', 'period', 'decay', 'amplitude', 'wave_height', 'wave_length' or 'reflection'; found 'around'. Correct it."),
    "key": ("within", "whitin", "expect.e.whitin is not known. Did you mean within?"),
    "no table": ("[[expect]]", "[expect]", "expect must be a list of tables; found {"),
}  # fmt: skip


@pytest.mark.parametrize("case", EXPECTATIONS)
def test_a_wrong_expectation_is_refused(scene, capsys, case):
    old, new, words = EXPECTATIONS[case]
    lines = mistakes_of(scene(more=EXPECT.replace(old, new, 1)), capsys)
    assert any(line.startswith(words) for line in lines), lines


ARGUMENTS = {
    "preset": (["--preset", "quik"], "preset quik is not known. Did you mean quick?"),
    "set path": (["--set", "outptu.interval=1"], "outptu is not known. "),
    "set component": (["--set", "components.peng.items=1"], "components.peng is not known. Did you mean pong?"),
    "set inside a number": (["--set", "end.of=1"], "end.of cannot be set: end is not a table."),
    "set without =": (["--set", "end"], "--set needs PATH=VALUE; found 'end'."),
    "set wrong value": (["--set", "end=-1"], "scene.end should be greater than 0; found -1."),
    "set wrong key": (["--set", "components.pong.itms=2"], "components.pong.itms is not known. Did you mean items?"),
    "set in a table that it lacks": (["--set", "components.pong.grops.size=2"], "components.pong.grops is not known. "),
    "swap name": (["--swap", "peng=echo"], "--swap peng=echo: component peng is not known. Did you mean pong?"),
    "swap kind": (["--swap", "pong=ecko"], "--swap pong=ecko: kind ecko is not known. Did you mean echo?"),
    "swap form": (["--swap", "pong"], "--swap needs NAME=KIND; found 'pong'."),
    "replay": (["--swap", "pong=replay@nowhere"], "components.pong: recording "),
    "elsewhere": (["--elsewhere", "peng"], "quintet: --elsewhere needs components of the scene, and the transport zenoh."),
}  # fmt: skip


@pytest.mark.parametrize("case", ARGUMENTS)
def test_a_wrong_argument_is_refused(scene, capsys, case):
    arguments, words = ARGUMENTS[case]
    lines = mistakes_of(scene(more="\n[presets.quick]\nend = 0.1\n"), capsys, *arguments)
    assert any(line.startswith(words) for line in lines), lines


def test_all_mistakes_are_told_at_once(scene, capsys):
    lines = mistakes_of(
        scene(
            ("end = 1.0", "end = -1.0\ncolour = 3"),
            ("[components.pong]", "[components.pong]\nitms = 3"),
            ('kind = "direct"', 'kind = "dirct"'),
        ),
        capsys,
    )
    assert [line.split(" ")[0] for line in lines] == [
        "scene.end", "scene.colour", "components.pong.itms", "links.0.kind",
    ]  # fmt: skip


def test_what_follows_from_a_mistake_is_not_told(scene, capsys):
    path = scene(("[components.pong]", "[components.pong]\nitms = 3"), more=EXPECT)
    assert mistakes_of(path, capsys, "--set", 'order=["pong","ping"]') == [
        "components.pong.itms is not known. Did you mean items?"
    ]


def test_a_recording_that_is_none_is_refused(scene, capsys, tmp_path):
    path = scene()
    (tmp_path / "recording.h5").write_text("not HDF5")
    lines = mistakes_of(path, capsys, "--swap", f"pong=replay@{tmp_path}")
    assert len(lines) == 1 and lines[0].startswith("components.pong: recording ")
    assert "it must be a whole recording of quintet; reading it found OSError: " in lines[0]


def test_bytes_that_are_no_text_are_refused(scene, capsys):
    path = scene()
    path.write_bytes(b"\xff\xfe\x00name")
    assert mistakes_of(path, capsys)[0].startswith("a scene must be valid TOML: ")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        (
            "dam_brek_cubes",
            "quintet: scene dam_brek_cubes is not known. Did you mean dam_break_cubes?",
        ),
        (
            "no/such.toml",
            "quintet: scene no/such.toml: there is no such file. Give a name or a path.",
        ),
    ],
)
def test_a_scene_that_is_not_there_is_refused(capsys, tmp_path, monkeypatch, name, words):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as exit_info:
        main(["run", name])
    assert exit_info.value.code == 2
    assert capsys.readouterr().err.strip() == words
    assert not list(tmp_path.iterdir())


def test_links_need_names_of_their_own(scene):
    more = f'\n[[links]]\nkind = "direct"\n{PAIRS}\n'
    with pytest.raises(SceneError, match=r"links: 2 have the name ping-pong\. Give each its own"):
        load(str(scene(more=more)))


def test_settings_reach_what_they_name(scene):
    path = scene(more='\n[presets.quick]\nend = 0.1\n"components.pong.items" = 7\n')
    loaded_scene = load(str(path), "quick", ["components.ping.items=3", "output.interval=0.05"])
    assert loaded_scene.file.end == 0.1 and loaded_scene.file.output.interval == 0.05
    assert [component.checked.items for component in loaded_scene.components.values()] == [3, 7]
    assert (
        loaded_scene.resolved["components"]["pong"]["items"] == 7
        and "presets" not in loaded_scene.resolved
    )


def test_components_step_in_the_order_that_is_asked_for(scene):
    loaded_scene = load(str(scene()), settings=['order=["pong", "ping"]'])
    assert list(loaded_scene.components) == ["pong", "ping"]
