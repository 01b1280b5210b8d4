"""Components on other hosts: the bits of one host, whatever the network does meanwhile."""

import re
import time

import pytest
from started import Started, same

from quintet.coupler.cli import main

pytestmark = [pytest.mark.zenoh, pytest.mark.full]
NOTICE = 10.0  # s


def check_same(run):
    """The run ended well, with the bits of a run on one host, also according to `quintet diff`."""
    status, screen = run.wait()
    assert status == 0, screen
    reference = Started(run.scene, "--transport", "memory", out=run.scene.parent / "alone")
    assert reference.wait(200.0) == 0, reference.err
    assert same(run.run.folder, reference.folder)
    with pytest.raises(SystemExit) as exit_info:
        main(["diff", str(run.run.folder), str(reference.folder)])
    assert exit_info.value.code == 0
    return screen


@pytest.mark.parametrize("count", [2, 3])
def test_several_hosts_give_the_bits_of_one(network, spread, count):
    hosts = network(count).hosts
    names = ("pong", "ping")[: count - 1]
    run = spread(hosts, dict(zip(names, hosts[1:], strict=True)))
    screen = check_same(run)
    assert "sign" not in screen
    assert all(program.wait(10.0) == 0 for program in run.joined.values())


def test_a_slow_network_that_loses_frames_gives_the_same_bits(network, spread):
    hosts = network(2, delay=0.02, loss=0.01).hosts
    toys = {"ping": "items = 100", "pong": "items = 100"}
    assert "sign" not in check_same(spread(hosts, {"pong": hosts[1]}, end=0.2, toys=toys))


@pytest.mark.parametrize("link_down", [False, True])
@pytest.mark.parametrize("seconds", [5.0, 30.0])
def test_a_link_that_was_cut_is_noticed_and_the_run_goes_on(network, spread, seconds, link_down):
    switch = network(2)
    host = switch.hosts[1]
    run = spread(switch.hosts, {"pong": host}, "--set", "restarts=0")
    run.wait_for_step("pong", host)
    start = time.monotonic()
    switch.cut(host, link_down)
    if seconds > NOTICE:
        notice_time = run.wait_for_words("pong: no sign of life from host2 for", NOTICE)
        assert notice_time < NOTICE
        print(f"noticed after {notice_time:.1f} s")
    time.sleep(max(0.0, seconds - (time.monotonic() - start)))
    switch.heal(host)
    screen = check_same(run)
    print(f"ended {time.monotonic() - start:.1f} s after the cut; the screen: {screen}")
    if seconds > NOTICE:
        assert "the run waits up to 60 s more for it" in screen
        assert re.search(r"pong: host2 gives signs of life again, after \d+ s", screen)
    assert run.joined["pong"].wait(10.0) == 0


@pytest.mark.parametrize("items", [10, 50_000])  # messages of 2.4 MB fill buffers
def test_a_host_that_disappears_ends_the_run_without_restarts(network, spread, items):
    switch = network(2)
    host = switch.hosts[1]
    toys = {"ping": f"items = {items}", "pong": f"items = {items}"}
    run = spread(switch.hosts, {"pong": host}, "--set", "patience=15.0", end=4.0, toys=toys)
    run.wait_for_step("pong", host, 200.0)
    switch.cut(host)
    host.kill()
    seconds = run.wait_for_words("pong failed in window", NOTICE + 15.0)
    print(f"given up after {seconds:.1f} s")
    assert run.wait(30.0)[0] == 3
    fault = run.run.results["fault"]
    assert fault["component"] == "pong"
    cause = r"host host2 does not answer: no sign of life from host2 for 2[34] s"
    assert re.fullmatch(cause, fault["cause"]), fault
    assert not run.run.left_processes()


def test_another_host_takes_over_from_the_one_that_disappeared(network, spread):
    switch = network(3)
    _, lost_host, new_host = switch.hosts
    run = spread(switch.hosts, {"pong": lost_host}, "--set", "restarts=1", "--set", "patience=15.0")
    run.wait_for_step("pong", lost_host)
    switch.cut(lost_host)
    lost_host.kill()
    seconds = run.wait_for_words("it is awaited again (restart 1 of 1)", NOTICE + 15.0)
    print(f"awaited again after {seconds:.1f} s")
    process = run.join("pong", new_host)
    screen = check_same(run)
    assert process.wait(10.0) == 0
    (note,) = run.run.results["notes"]["pong"]
    assert "host host2 does not answer" in note and "with the same bits" in note
    assert "pong goes on: " in screen


def check_put_out(run, host, program):
    """A replaced component ends by itself, and gives the reason."""
    assert program.wait(90.0) == 3  # TCP looks again after as long as the cut has lasted
    text = run.log_of("pong", host).read_text()
    assert "pong: the coupler: the run has given up this process" in text, text
    assert "another one takes its place as pong" in text


@pytest.mark.parametrize("fault", ["cut", "stop"])
def test_who_comes_back_after_another_took_over_ends_by_itself(network, spread, fault):
    switch = network(3)
    _, old_host, new_host = switch.hosts
    toys = {"ping": "pause = 0.02", "pong": ""}  # a minute, for the former one to come back
    settings = ("--set", "restarts=1", "--set", "patience=15.0")
    run = spread(switch.hosts, {"pong": old_host}, *settings, end=3.0, toys=toys)
    run.wait_for_step("pong", old_host)
    if fault == "cut":
        switch.cut(old_host)
    else:
        run.stop("pong")
    run.wait_for_words("it is awaited again (restart 1 of 1)", NOTICE + 15.0)
    run.join("pong", new_host)
    run.wait_for_words("pong goes on: ", 30.0)
    if fault == "cut":
        switch.heal(old_host)
    else:
        run.go_on("pong")
    check_put_out(run, old_host, run.joined["pong"])
    check_same(run)
