import csv
import gc
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import topple

ARRAYS = [name for name, kind in vars(topple.Result).items()
          if isinstance(kind, property) and kind.__doc__.startswith("[")]


def table(file):
    with open(file, newline="") as lines:
        return list(csv.DictReader(lines))


def test_the_summary_is_that_of_the_program(program):
    mine, theirs = topple.Scene("paper-a").run().summary, program.run("paper-a")
    for how_long in "wall_s", "realtime_factor":
        assert mine.pop(how_long) > 0 and theirs.pop(how_long) > 0
    assert mine == theirs


def test_modes_are_in_the_summary(program):
    result = topple.Scene("elements/cabinet-frame").run()
    assert result.summary == program.run("elements/cabinet-frame")
    assert result.time.shape == (0,)
    with pytest.raises(topple.InputError, match="nothing to draw"):
        result.render()


def test_rows_are_those_that_the_program_records(recording, tmp_path):
    file = tmp_path / "mine.h5"
    result = topple.Scene("paper-a").run(record=file)
    for other in topple.open(recording), topple.open(file):
        assert len(ARRAYS) > 20
        for name in ARRAYS:
            np.testing.assert_array_equal(getattr(result, name), getattr(other, name), err_msg=name)
        for name, values in result.energy.items():
            np.testing.assert_array_equal(values, other.energy[name], err_msg=name)
        assert result.states == other.states and len(result.states) > 5
        assert result.scene_text == other.scene_text
    assert topple.open(file).summary == result.summary


def test_arrays_are_the_columns_of_the_tables(program, recording, tmp_path):
    result = topple.open(recording)
    assert program("export", recording, "--csv", tmp_path).returncode == 0

    def columns(name, *keys):
        return np.array([[float(row[key]) for key in keys] for row in table(tmp_path / name)])

    header = {name: list(table(tmp_path / name)[0]) for name in ("bodies.csv", "nodes.csv", "energy.csv")}
    nodes = columns("nodes.csv", *header["nodes.csv"][3:6]).reshape(result.position.shape)
    np.testing.assert_array_equal(nodes.astype(np.float32), result.position)
    bodies = columns("bodies.csv", *header["bodies.csv"][2:]).reshape(*result.tilt.shape, -1)
    np.testing.assert_array_equal(bodies[..., :3], result.centre)
    np.testing.assert_array_equal(bodies[..., 3:7], result.body_rotation)
    np.testing.assert_array_equal(bodies[..., 7], result.tilt * 180 / np.pi)
    np.testing.assert_array_equal(bodies[..., 8], result.slide)
    np.testing.assert_array_equal(bodies[..., 9], result.body_energy)
    energies = columns("energy.csv", *header["energy.csv"][1:])
    np.testing.assert_array_equal(energies, np.stack(list(result.energy.values()), axis=-1))
    names = [row["body"] for row in table(tmp_path / "nodes.csv")[: len(result.nodes)]]
    assert names == [body for body, _ in result.nodes]


def test_a_body_in_free_flight_is_on_a_parabola():
    scene = topple.Scene("tumble")
    scene["run.gravity"] = [0, 0, -9.80665]
    scene["run.duration"] = 2
    result = scene.run()
    z, t = result.centre[:, 0, 2], result.time
    # Central differences are exact where the acceleration is constant: what is left is a rounding in each step.
    rounding = result.step[-1] * np.finfo(float).eps * np.abs(z).max()
    np.testing.assert_allclose(z, z[0] - 9.80665 * t**2 / 2, rtol=0, atol=rounding)


def test_arrays_share_one_memory_and_are_read_only():
    result = topple.Scene("free-rocking").run()
    assert np.shares_memory(result.position, result.position)
    assert np.shares_memory(result.energy["kinetic"], result.energy["kinetic"])
    # columns of one block
    assert result.tilt.strides == result.slide.strides
    assert (result.slide.__array_interface__["data"][0] - result.tilt.__array_interface__["data"][0]) == 8
    with pytest.raises(ValueError, match="read-only"):
        result.position[0] = 0
    with pytest.raises(ValueError):
        result.tilt.flags.writeable = True


def test_arrays_outlive_the_result():
    result = topple.Scene("free-rocking").run()
    position, kept = result.position, result.position.copy()
    address = position.__array_interface__["data"][0]
    del result
    gc.collect()
    others = [topple.Scene("free-rocking").run() for _ in range(3)]  # would take memory that was given back
    assert all(other.position.__array_interface__["data"][0] != address for other in others)
    np.testing.assert_array_equal(position, kept)


def test_a_run_that_fails_warns_and_keeps_its_rows():
    scene = topple.Scene("cantilever")
    scene["run.integrator"] = "central-difference"  # its step is too long for that
    with pytest.warns(RuntimeWarning, match='^cantilever: .*stable up to a time_step of'):
        result = scene.run()
    assert result.summary["status"] == "diverged" and result.time.tolist() == [0]
    with pytest.raises(topple.RunError, match='^cantilever: .*stable up to a time_step of'):
        topple.Simulation(scene).step()


def test_a_foreign_file_is_refused(tmp_path, source):
    with pytest.raises(topple.InputError, match="CMakeLists.txt"):
        topple.open(source / "CMakeLists.txt")
    with pytest.raises(topple.InputError, match="none.h5"):
        topple.open(tmp_path / "none.h5")
    notes = tmp_path / "notes.txt"
    notes.write_text("mine\n")
    with pytest.raises(topple.InputError, match="notes.txt"):
        topple.Scene("free-rocking").run(record=notes)
    assert notes.read_text() == "mine\n"
    with pytest.raises(OSError, match="no-such-folder"):
        topple.Scene("free-rocking").run(record=tmp_path / "no-such-folder" / "a.h5")


@pytest.mark.parametrize("recorded", [False, True])
def test_ctrl_c_ends_a_run_within_a_second(tmp_path, recorded):
    file = tmp_path / "long.h5"
    script = ("import topple\nscene = topple.Scene('free-rocking')\nscene['run.duration'] = 3600\n"
              f"print('begins', flush=True)\nscene.run({str(file)!r} if {recorded} else None)\n")
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as child:
        assert child.stdout.readline() == "begins\n"
        time.sleep(0.5)  # it is at work
        child.send_signal(signal.SIGINT)
        sent = time.monotonic()
        error = child.communicate(timeout=60)[1]
        assert time.monotonic() - sent < 1
    assert error.strip().endswith("KeyboardInterrupt")
    assert child.returncode == -signal.SIGINT
    if recorded:
        left = topple.open(file)
        assert left.summary["status"] == "interrupted" and left.time[-1] > 1
