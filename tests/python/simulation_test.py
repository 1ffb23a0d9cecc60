import gc
import os
import signal
import threading
import time

import numpy as np
import pytest

import topple


def at_step(simulation, step):
    while simulation.steps < step:
        simulation.step()
    return simulation.state_hash


@pytest.mark.parametrize("scene", ["paper-a", "yielding", "anchored", "portal-pushover"])
def test_its_states_are_those_of_the_program(program, tmp_path, scene):
    file = tmp_path / "theirs.h5"
    program.run(scene, "-o", file)
    states = topple.open(file).states
    simulation = topple.Simulation(topple.Scene(scene))
    assert [(step, at, at_step(simulation, step)) for step, at, _ in states] == states
    assert simulation.over


def test_what_is_set_later_does_not_reach_it():
    scene = topple.Scene("free-rocking")
    one, other = topple.Simulation(scene), topple.Simulation(scene)
    scene["run.duration"] = 0.01
    one.run_until(1)
    other.run_until(1)
    assert one.time >= 1 and one.state_hash == other.state_hash


def test_arrays_follow_the_state():
    simulation = topple.Simulation(topple.Scene("free-rocking"))
    tilt, position, kinetic = simulation.tilt, simulation.position, simulation.energy["kinetic"]
    before = tilt.copy(), position.copy(), kinetic.copy()
    simulation.run_until(0.2)
    assert (tilt != before[0]).all() and (position != before[1]).any() and kinetic > before[2]
    assert np.shares_memory(tilt, simulation.tilt) and np.shares_memory(position, simulation.position)
    result = topple.Scene("free-rocking").run()
    while simulation.steps < result.step[-1]:
        simulation.step()
    np.testing.assert_array_equal(position, result.position[-1])
    np.testing.assert_array_equal(tilt, result.tilt[-1])
    last = tilt.copy()
    del simulation
    gc.collect()
    np.testing.assert_array_equal(tilt, last)


def test_forks_part_where_one_is_edited():
    trunk, alone = (topple.Simulation(topple.Scene("paper-a")) for _ in range(2))
    for one in trunk, alone:
        one.run_until(0.3)
        one.edit("shake.1.amplitude", "200 gal")
    trunk.run_until(0.5)
    same, edited = trunk.fork(), trunk.fork()
    assert same.time == trunk.time and same.state_hash == trunk.state_hash
    edited.edit("shake.1.amplitude", "10 gal")
    tilt = trunk.tilt
    kept = tilt.copy()
    edited.run_until(2)
    np.testing.assert_array_equal(tilt, kept)
    for one in trunk, same, alone:
        one.run_until(2)
    assert trunk.state_hash == same.state_hash == alone.state_hash != edited.state_hash
    assert edited.tilt[0] < trunk.tilt[0]


def test_what_is_edited_at_the_start_is_what_the_scene_could_have_said():
    keys = {"contact.alpha": "36000 kgf", "shake.1.amplitude": "170 gal", "contact.q": 1.2}
    scene = topple.Scene("paper-a")
    for key, value in keys.items():
        scene[key] = value
    said, edited = topple.Simulation(scene), topple.Simulation(topple.Scene("paper-a"))
    for key, value in keys.items():
        edited.edit(key, value)
    assert edited.state_hash == said.state_hash
    np.testing.assert_array_equal(edited.position, said.position)
    forked = edited.fork()
    for one in said, edited, forked:
        one.run_until(3)
    assert edited.state_hash == said.state_hash == forked.state_hash


def test_an_edit_at_the_start_that_does_not_settle_says_so_and_may_be_taken_back():
    simulation = topple.Simulation(topple.Scene("paper-a"))
    before = simulation.state_hash
    with pytest.raises(topple.RunError, match="^paper-a: .*does not come to rest"):
        simulation.edit("contact.alpha", "0.001 kgf")
    with pytest.raises(topple.RunError):
        simulation.step()
    simulation.edit("contact.alpha", "50 kgf")
    assert simulation.state_hash == before
    simulation.step()


def test_what_is_pulled_tips_and_let_go_of_falls_back():
    scene = topple.Scene("cabinet")
    scene["shake.1.amplitude"] = "1 gal"
    scene["run.time_step"] = 0.001
    simulation = topple.Simulation(scene)
    top = int(np.argmax(simulation.position[:, 2])) + 1
    simulation.edit(f"node.{top}.pull", ["150 N", 0, 0])
    while simulation.tilt[0] < 0.03:
        simulation.step()
    assert simulation.time < 1
    simulation.edit(f"node.{top}.pull", [0, 0, 0])
    simulation.run_until(6)
    assert simulation.tilt[0] < 0.01


def test_values_of_edits_are_those_of_scenes():
    one, other = (topple.Simulation(topple.Scene("paper-a")) for _ in range(2))
    for simulation, amplitude in ((one, "120 gal"), (other, 1.2)):
        simulation.edit("shake.1.amplitude", amplitude)
        simulation.edit("shake.1.direction", [0.6, 0.8, 0])
        simulation.edit("run.want", ["motion"])
        simulation.edit("contact.friction", 0.5)
        simulation.edit("shake.1.on", True)
        simulation.run_until(0.5)
    assert one.state_hash == other.state_hash


@pytest.mark.parametrize(
    "key, value, says",
    [
        ("shake.1.amplitude", "150 mm", r'^shake\.1\.amplitude: "150 mm" is a length, expected an acceleration \('),
        ("contact.friction", 2.4, r"^contact\.friction: 2\.4 is outside 0\.\.1\.5$"),
        ("shake.2.amplitude", 1, r"^shake\.2\.amplitude: there is no such shake; the scene has 1$"),
        ("run.integrator", "euler", r'^run\.integrator: "euler" is not one of .*newmark'),
        ("shake.1.on", "maybe", r'^shake\.1\.on: "maybe" is not true or false$'),
        ("shake.1.direction", [1, 2, 3, 4], r"^shake\.1\.direction: .* is not a list of 3$"),
        ("node.99.pull", [1, 0, 0], r"^node\.99\.pull: there is no such node; the scene has \d+$"),
        ("node.3.pull", 5, r"^node\.3\.pull: 5 is not a list of 3$"),
        ("node.3.pull", ["3 kg", 0, 0], r'^node\.3\.pull: "3 kg" is a mass, expected a force \('),
        ("cabinet.1.mass", 1, r"^cabinet\.1\.mass: cannot be changed while it runs; what can: .*shake\.1\.amplitude"),
    ],
)
def test_a_wrong_edit_says_what_is_wrong_and_changes_nothing(key, value, says):
    simulation = topple.Simulation(topple.Scene("paper-a"))
    before = simulation.state_hash
    with pytest.raises(topple.InputError, match=says):
        simulation.edit(key, value)
    assert simulation.state_hash == before


def test_the_end_is_said():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 0.1
    simulation = topple.Simulation(scene)
    simulation.run_until(100)
    assert simulation.over
    with pytest.raises(topple.RunError, match="^free-rocking: is over, at 0.1 s$"):
        simulation.step()


TORN = """
topple = 1
run = { duration = "0.1 s", settle = false, gravity = [0, 0, 0] }
material = [{ name = "steel", young = "205 GPa", poisson = 0.3, density = "7850 kg/m^3", yield = "235 MPa" }]
section = [{ name = "post", shape = "box", size = ["30 mm", "30 mm"], thickness = "1 mm" }]
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [-1e9, 0, -1], moment = [0, 1e9, 0], history = [[0.05, 0], [0.051, 1]] }]
"""


def test_a_failed_step_is_said_and_arrays_show_what_was_reached():
    simulation = topple.Simulation(topple.Scene.parse(TORN, "torn.toml"))
    position, start = simulation.position, simulation.position.copy()
    for _ in range(2):
        with pytest.raises(topple.RunError, match=r"^torn: .* after the step at 0\.05"):
            simulation.run_until(1)
    assert 0.05 < simulation.time < 0.1
    assert (position != start).any()
    with pytest.raises(topple.RunError, match="^torn: "):
        simulation.step()


def long_run():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 3600
    return topple.Simulation(scene)


def is_stepping(simulation):
    try:
        simulation.time
    except RuntimeError as error:
        assert "in another thread" in str(error)
        return True
    return False


def test_two_step_at_once_while_python_goes_on():
    simulations = long_run(), long_run()
    until = 60
    threads = [threading.Thread(target=one.run_until, args=[until]) for one in simulations]
    for thread in threads:
        thread.start()
    seen = False
    while any(thread.is_alive() for thread in threads):
        seen = seen or all(is_stepping(one) for one in simulations)
    assert seen
    assert simulations[0].state_hash == simulations[1].state_hash
    assert simulations[0].time == pytest.approx(until, abs=1e-6)  # steps are of 1 ms, times sums of them


def test_ctrl_c_ends_it_within_a_second_and_it_can_go_on():
    simulation = long_run()
    sent = []

    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, send)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.run_until(3600)
    assert time.monotonic() - sent[0] < 1
    assert 0 < simulation.time < 3600
    undisturbed = long_run()
    simulation.step()
    assert at_step(undisturbed, simulation.steps) == simulation.state_hash
