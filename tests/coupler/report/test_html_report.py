"""The page of a run is complete, shows the run's results, and needs no other file."""

import base64
import io
import re
import shutil
import subprocess
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from started import write_scene

from quintet.coupler.cli import main
from quintet.coupler.report import page as report_page
from quintet.coupler.report import report_figures as figures
from quintet.coupler.report.recorded import Series
from quintet.coupler.report.run_tables import references
from quintet.interfaces import libraries

VOID = {"meta", "img", "br", "hr", "link", "input"}


class Page(HTMLParser):
    """Elements of a page; it insists that all are closed in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.images, self.text = [], [], [], ""
        self.feed(text)
        self.close()
        assert not self.open, f"not closed: {self.open}"

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag == "img":
            self.images.append(dict(attrs)["src"])
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"closed in disorder: {tag}"

    def handle_data(self, data):
        self.text += data


def _call(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(list(map(str, arguments)))
    return exit_info.value.code


def _page(folder, *options):
    assert _call("report", folder, *options) == 0
    return Page((folder / "report.html").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def springs(tmp_path_factory):
    """A run with an expectation, pictures and two components."""
    out = tmp_path_factory.mktemp("runs") / "springs"
    settings = ["--set", "end=1.0", "--set", "output.pictures=[0.0,1.0]"]
    assert _call("run", "two_springs", *settings, "--transport", "memory", "--out", out) in (0, 1)
    return out


def test_the_page_says_where_references_are_from():
    outcome = {
        "name": "front", "value": 1.0, "reference": 1.1, "within": 0.2, "unit": "m", "met": True,
        "required": True, "source": "Martin & Moyce 1952", "reference_kind": "experiment",
        "read_from": "table", "doi": "10.1098/rsta.1952.0006", "licence": "none is stated",
    }  # fmt: skip
    (row,) = references({"expect": [outcome]}).rows
    assert row == [
        "front",
        "experiment",
        "table",
        *(outcome[k] for k in ("source", "doi", "licence")),
    ]
    (row,) = references({"expect": [{"name": "old", "source": "by hand"}]}).rows
    assert row == ["old", "-", "-", "by hand", "-", "-"]


def test_the_page_says_what_the_run_left(springs):
    page = _page(springs)
    for heading in ("Watched quantities", "References", "What moves", "Against references",
                    "Balances", "Time, and who waited for whom", "How to repeat it"):  # fmt: skip
        assert heading in page.text
    assert "quintet run" in page.text and "two_springs" in page.text
    assert "momentum residual" in page.text
    assert (springs / "report.html").stat().st_size < 5_000_000


def test_every_picture_of_the_page_can_be_decoded(springs):
    page = _page(springs)
    kinds = []
    for source in page.images:
        kind, data = re.fullmatch(r"data:([a-z/+]+);base64,(.+)", source).groups()
        content = base64.b64decode(data, validate=True)
        kinds.append(kind)
        if kind == "image/svg+xml":
            assert ElementTree.fromstring(content).tag.endswith("svg")
        else:
            Image.open(io.BytesIO(content)).verify()
    assert sorted(kinds) == ["image/png"] * 2 + ["image/svg+xml"] * 2


def test_the_page_needs_no_other_file_and_runs_no_script(springs):
    page = _page(springs)
    assert "script" not in {tag for tag, _ in page.tags}
    places = [value for _, attrs in page.tags for key, value in attrs.items()
              if key in ("src", "href")]  # fmt: skip
    assert places and all(place.startswith("data:") for place in places)
    assert not any(key.startswith("on") for _, attrs in page.tags for key in attrs)


def test_energies_are_drawn_of_the_components_that_tell_them():
    times = np.array([0.0, 0.5, 1.0])
    moving = {
        "kinetic": Series(np.array([0.0, 1.0, 3.0]), times, "J"),
        "potential": Series(np.array([5.0, 4.0, 3.0]), times, "J"),
        "work": Series(np.array([0.0, 0.0, 1.0]), times, "J"),
    }
    still = {"kinetic": Series(np.zeros(3), times, "J")}
    ledger = {"ball": moving, "plate": still}
    root = ElementTree.fromstring(figures.energies(ledger))
    assert root.tag.endswith("svg")
    assert figures.energies(ledger) == figures.energies(ledger), "the same bytes"
    assert figures.energies({"plate": still}) == ""
    _, total = figures._sum(moving)
    assert total.tolist() == [5.0, 5.0, 5.0], "what was done from outside is taken off"


def test_text_of_a_scene_is_no_markup(springs, tmp_path):
    scene = write_scene(tmp_path, end=0.01)
    scene.write_text(scene.read_text() + "\n# <script>alert(1)</script>\n")
    assert _call("run", scene, "--out", tmp_path / "out") == 0
    page = _page(tmp_path / "out")
    assert "script" not in {tag for tag, _ in page.tags}


def test_a_run_that_failed_has_a_page_with_its_fault(tmp_path):
    scene = write_scene(tmp_path, end=0.1, pong="fails_at = 3")
    assert _call("run", scene, "--transport", "memory", "--out", tmp_path / "out") == 3
    page = _page(tmp_path / "out")
    assert "Fault" in page.text and "pong failed in window 3" in page.text


def test_large_pictures_are_compressed(springs, tmp_path, monkeypatch):
    folder = tmp_path / "large"
    shutil.copytree(springs, folder)
    noise = np.random.default_rng(1).integers(0, 255, (1500, 2500, 3), dtype=np.uint8)
    Image.fromarray(noise).save(folder / "scene.png")
    assert (folder / "scene.png").stat().st_size > report_page.OF_PICTURES
    page = _page(folder, "--force")
    assert (folder / "report.html").stat().st_size < report_page.LARGEST
    assert page.images[0].startswith("data:image/jpeg")
    monkeypatch.setattr(report_page, "LARGEST", 1000)
    assert _call("report", folder) == 2


def test_what_is_there_is_not_replaced_and_what_lacks_is_told(springs, tmp_path, capsys):
    path = tmp_path / "mine.html"
    path.write_text("mine")
    assert _call("report", springs, "--out", path) == 2
    assert "it exists. Name another file, or use --force." in capsys.readouterr().err
    assert path.read_text() == "mine"
    assert _call("report", springs, "--out", tmp_path / "a.pdf") == 2
    assert "must end with one of .html; found .pdf" in capsys.readouterr().err
    assert _call("report", tmp_path) == 2
    assert "it has no results.json" in capsys.readouterr().err


def test_a_missing_library_is_told(springs, monkeypatch, capsys):
    monkeypatch.setattr(libraries, "is_installed", lambda library: library != "jinja2")
    assert _call("report", springs) == 2
    assert "pip install 'quintet[report]'" in capsys.readouterr().err


@pytest.mark.full
def test_a_browser_shows_the_page_without_an_error(springs, tmp_path):
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if not browser:
        pytest.skip("no browser is installed")
    _page(springs)
    picture, page = tmp_path / "page.png", (springs / "report.html").as_uri()
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr"]
    command += ["--window-size=1200,3000", f"--screenshot={picture}", page]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "CONSOLE" not in result.stderr
    with Image.open(picture) as image:
        pixels = np.asarray(image.convert("RGB"))
    assert pixels.reshape(-1, 3).std() > 10.0, "it is not blank"
