"""A component computes where its scene says, or says why it cannot."""

import importlib.util
import json
import subprocess
import sys

import pytest

from quintet.components.shared.opencl import __main__ as listing
from quintet.components.shared.opencl.devices import NO_DEVICE, bandwidth, device_of
from quintet.coupler.launch.acceptance import settings
from quintet.coupler.scene.read import load
from quintet.interfaces import libraries
from quintet.interfaces.errors import OrderError, SceneError
from quintet.interfaces.manifest import find
from quintet.interfaces.serving.orders import check_order


def scene(name, component, device, **more):
    key = f"components.{component}"
    given = {f"{key}.device": device, **{f"{key}.{k}": v for k, v in more.items()}}
    return load(name, preset="quick", settings=[f"{k}={v!r}" for k, v in given.items()])


def test_the_device_of_a_scene_goes_to_its_component():
    on_device = scene("still_water", "water", "opencl:1")
    assert on_device.components["water"].device == "opencl:1"
    assert settings(on_device, "water")["device"] == "opencl:1"
    assert "device" not in settings(scene("still_water", "water", "cpu"), "water")
    assert on_device.resolved["components"]["water"]["device"] == "opencl:1"


WRONG = [
    ("still_water", "water", "gpu", {}, r"water\.device must be cpu, opencl, or opencl:0.*'gpu'"),
    ("still_water", "water", "opencl:x", {}, r"found 'opencl:x'.*`quintet devices` lists"),
    ("sphere_rebound", "spheres", "opencl", {}, r"device must be cpu, for kind dem_bodies.*Remove"),
    ("still_water", "water", "opencl", {"ranks": 2}, r"ranks must be 1 on a device; found 2 and"),
]


@pytest.mark.parametrize(("name", "component", "device", "more", "words"), WRONG)
def test_a_device_that_a_component_cannot_use_is_refused(name, component, device, more, words):
    with pytest.raises(SceneError, match=words):
        scene(name, component, device, **more)


def test_a_kind_without_devices_refuses_them_as_it_is_loaded():
    with pytest.raises(SceneError, match=r"kind dem_bodies must compute on the processor.*opencl"):
        find("dem_bodies").load("opencl")


def test_an_order_names_its_device():
    header = {"threads": 1, "params": {}, "device": 3}
    with pytest.raises(OrderError, match=r"order go: device must be the name of a device; found 3"):
        check_order("go", header)


def test_a_missing_library_says_how_to_install_it(monkeypatch, capsys):
    monkeypatch.setattr(libraries, "find_spec", lambda name: None)
    assert listing.main() == 2
    said = capsys.readouterr().err
    assert "an OpenCL device needs the library pyopencl; it is not installed" in said
    assert "pip install 'quintet[opencl]'" in said


def test_a_machine_without_drivers_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setattr(listing, "devices", lambda: [])
    assert listing.main() == 2
    assert "No OpenCL device was found. Install the driver of yours" in capsys.readouterr().err
    monkeypatch.setattr("quintet.components.shared.opencl.devices.devices", lambda: [])
    with pytest.raises(SceneError) as caught:
        device_of("opencl")
    assert NO_DEVICE in str(caught.value)


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_devices_are_listed_with_memory_precision_and_bandwidth(monkeypatch, capsys):
    monkeypatch.setattr(listing, "bandwidth", lambda device: 12.34e9)
    assert listing.main() == 0
    said = capsys.readouterr().out
    assert said.startswith("opencl:0  ")
    assert listing.main(["--json"]) == 0
    first = json.loads(capsys.readouterr().out)[0]
    assert first.keys() == {"device", "name", "units", "memory", "doubles", "bandwidth"}
    assert first["device"] == "opencl:0" and first["bandwidth"] == 12.34e9
    assert "GiB" in said and "double precision" in said and "copies 12.3 GB/s" in said


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_bandwidth_is_measured(monkeypatch):
    monkeypatch.setattr("quintet.components.shared.opencl.devices.COPIED", 1 << 20)
    device = device_of("opencl")
    assert 1e7 < bandwidth(device) < 1e14


def test_reading_a_scene_loads_no_opencl():
    program = (
        "import sys; from quintet.coupler.scene.read import load; load('still_water');"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
