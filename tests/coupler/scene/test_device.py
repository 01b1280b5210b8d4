"""A component computes on the device of its scene, or gives the reason why it cannot."""

import importlib.util
import json
import subprocess
import sys
from dataclasses import replace

import pytest

from quintet.components.shared.opencl import __main__ as listing
from quintet.components.shared.opencl.devices import NO_DEVICE, bandwidth, device_of, is_any_there
from quintet.coupler.launch.acceptance import settings
from quintet.coupler.scene import component_tables
from quintet.coupler.scene.read import load
from quintet.interfaces import libraries
from quintet.interfaces.errors import OrderError, SceneError, StepError
from quintet.interfaces.manifest import find
from quintet.interfaces.serving.orders import check_order


def scene(name, component, device, **keys):
    key = f"components.{component}"
    settings = {f"{key}.device": device, **{f"{key}.{k}": v for k, v in keys.items()}}
    return load(name, preset="quick", settings=[f"{k}={v!r}" for k, v in settings.items()])


def test_the_device_of_a_scene_goes_to_its_component():
    on_device = scene("still_water", "water", "opencl:1")
    assert on_device.components["water"].device == "opencl:1"
    assert settings(on_device, "water")["device"] == "opencl:1"
    assert "device" not in settings(scene("still_water", "water", "cpu"), "water")
    assert on_device.resolved["components"]["water"]["device"] == "opencl:1"


WRONG = [
    ("still_water", "water", "gpu", {}, r"water\.device must be cpu, opencl, or opencl:0.*'gpu'"),
    ("still_water", "water", "opencl:x", {}, r"found 'opencl:x'.*`quintet devices` lists"),
    ("plate_modes", "plate", "opencl", {}, r"device must be cpu, for kind fe_plate.*Remove"),
    (
        "still_water",
        "water",
        "opencl:0,1",
        {},
        r"must have one number, for all ranks, or one for.*"
        r"found opencl:0,1 and ranks = 1",
    ),
    ("still_water", "water", "opencl:0,1", {"ranks": 3}, r"found opencl:0,1 and ranks = 3"),
    ("still_water", "water", "opencl:0,", {"ranks": 2}, r"of several ranks also opencl:0,1"),
]


@pytest.mark.parametrize(("name", "component", "device", "keys", "words"), WRONG)
def test_a_device_that_a_component_cannot_use_is_refused(name, component, device, keys, words):
    with pytest.raises(SceneError, match=words):
        scene(name, component, device, **keys)


def test_a_kind_that_computes_on_one_device_refuses_several_ranks(monkeypatch):
    one_device = replace(find("sph_fluid"), opencl_ranks="")
    monkeypatch.setattr(component_tables, "find", lambda kind: one_device)
    match = r"ranks must be 1 of kind sph_fluid on a device; found 2 and opencl. Remove one"
    with pytest.raises(SceneError, match=match):
        scene("still_water", "water", "opencl", ranks=2)


def test_ranks_share_a_device_or_have_one_each():
    for device in ("opencl", "opencl:1", "opencl:0,1"):
        keys = {"ranks": 2, "device": device}
        settings = [f"components.water.{key}={value!r}" for key, value in keys.items()]
        plan = load("still_water", settings=[*settings, "transport='mpi'"]).components["water"]
        assert (plan.ranks, plan.device) == (2, device)


def test_a_misspelt_device_is_told_from_keys_of_the_kind():
    with pytest.raises(SceneError, match=r"water\.devise is not known\. Did you mean device\?"):
        load("still_water", settings=["components.water.devise='opencl'"])


def test_a_kind_without_devices_refuses_them_as_it_is_loaded():
    with pytest.raises(SceneError, match=r"kind fe_plate must compute on the processor.*opencl"):
        find("fe_plate").load("opencl")


def test_an_order_names_its_device():
    header = {"threads": 1, "params": {}, "device": 3}
    with pytest.raises(OrderError, match=r"order go: device must be the name of a device; found 3"):
        check_order("go", header)


def test_a_missing_library_says_how_to_install_it(monkeypatch, capsys):
    monkeypatch.setattr(libraries, "find_spec", lambda name: None)
    assert listing.main() == 2
    message = capsys.readouterr().err
    assert "an OpenCL device needs the library pyopencl; it is not installed" in message
    assert "pip install 'quintet[opencl]'" in message


def test_a_machine_without_drivers_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setattr(listing, "devices", lambda: [])
    assert listing.main() == 2
    assert (
        "No OpenCL device was found. Install the driver of your device" in capsys.readouterr().err
    )
    monkeypatch.setattr("quintet.components.shared.opencl.devices.devices", lambda: [])
    with pytest.raises(SceneError) as error_info:
        device_of("opencl")
    assert NO_DEVICE in str(error_info.value)


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_devices_are_listed_with_memory_precision_and_bandwidth(monkeypatch, capsys):
    monkeypatch.setattr(listing, "bandwidth", lambda device: 12.34e9)
    assert listing.main() == 0
    output = capsys.readouterr().out
    assert output.startswith("opencl:0  ")
    assert listing.main(["--json"]) == 0
    first = json.loads(capsys.readouterr().out)[0]
    assert first.keys() == {"device", "name", "units", "memory", "doubles", "bandwidth"}
    assert first["device"] == "opencl:0" and first["bandwidth"] == 12.34e9
    assert "GiB" in output and "double precision" in output and "copies 12.3 GB/s" in output


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_bandwidth_is_measured(monkeypatch):
    monkeypatch.setattr("quintet.components.shared.opencl.devices.COPIED", 1 << 20)
    device = device_of("opencl")
    assert 1e7 < bandwidth(device) < 1e14


@pytest.mark.parametrize("name", ["gpu", "opencl:x", "opencl:-1", "OPENCL", ""])
def test_a_device_of_another_name_is_refused_where_it_is_resolved(name):
    with pytest.raises(SceneError, match=rf"must be cpu, opencl, or opencl:0.*found '{name}'"):
        device_of(name)


def refuse_xsph(params, device):
    if params.xsph:
        raise SceneError(f"on device {device}, xsph must be 0; found {params.xsph}.")


def test_check_refuses_what_the_run_on_a_device_would(monkeypatch):
    limited = replace(find("sph_fluid"), opencl_limits=f"{__name__}:refuse_xsph")
    monkeypatch.setattr(component_tables, "find", lambda kind: limited)
    with pytest.raises(SceneError, match=r"water.*on device opencl, xsph must be 0; found 0.5"):
        scene("still_water", "water", "opencl", xsph=0.5)


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_a_device_that_fails_does_not_hide_the_others(monkeypatch, capsys):
    (first_device, *_) = listing.devices()
    monkeypatch.setattr(listing, "devices", lambda: [first_device, replace(first_device, number=7)])

    def bandwidth_of(device):
        if device.number != 7:
            raise listing.opencl().LogicError("no context")
        return 1e9

    monkeypatch.setattr(listing, "bandwidth", bandwidth_of)
    assert listing.main() == 0
    screen = capsys.readouterr()
    assert "opencl:0 cannot be used: " in screen.err and screen.out.startswith("opencl:7  ")


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_an_array_that_has_no_room_tells_bytes_and_limit():
    from quintet.components.shared.opencl.arrays import DeviceArray

    with pytest.raises(SceneError, match=r"at most \d+ bytes.*found one of 8000000000000000 bytes"):
        DeviceArray(device_of("opencl").queue(), (10**15,))


@pytest.mark.skipif(not importlib.util.find_spec("pyopencl"), reason="needs pyopencl")
def test_a_kernel_that_finds_no_room_says_how_much_it_needs():
    from quintet.components.shared.opencl.arrays import DeviceArray, run

    def kernel(*_):
        raise listing.opencl().MemoryError("no room")

    queue = device_of("opencl").queue()
    with pytest.raises(StepError, match=r"memory of \d+ bytes; found no room for 80 bytes"):
        run(queue, kernel, 10, DeviceArray(queue, (10,)))


def test_devices_are_tried_only_where_there_is_one(monkeypatch):
    manifest = find("sph_fluid")
    assert any(case.device == "opencl" for case in manifest.cases()) == is_any_there()
    monkeypatch.setattr("quintet.components.shared.opencl.devices.devices", lambda: [])
    assert {
        manifest_case.device for manifest_case in (*manifest.cases(), *manifest.conform_cases())
    } == {"cpu"}


def test_reading_a_scene_loads_no_opencl():
    program = (
        "import sys; from quintet.coupler.scene.read import load; load('still_water');"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
