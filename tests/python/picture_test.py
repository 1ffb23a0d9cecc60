import pytest

import topple

PNG = b"\x89PNG\r\n\x1a\n"


def size_of(png):
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


def test_a_picture_is_that_of_the_program(program, recording, tmp_path):
    file = tmp_path / "theirs.png"
    ended = program("render", recording, "--still", file, "--at", "2.345", "--size", "320x240")
    assert ended.returncode == 0, ended.stderr
    assert topple.open(recording).render(at=2.345, size=(320, 240)) == file.read_bytes()
    assert topple.Scene("paper-a").run().render(2.345, (320, 240)) == file.read_bytes()


def test_notebooks_show_the_last_instant():
    result = topple.Scene("free-rocking").run()
    shown = result._repr_png_()
    assert shown.startswith(PNG) and size_of(shown) == (1280, 720)
    assert shown == result.render(at=result.time[-1])


def test_a_simulation_shows_its_state():
    simulation = topple.Simulation(topple.Scene("free-rocking"))
    before = simulation.render(size=(320, 240))
    assert before.startswith(PNG) and size_of(before) == (320, 240)
    assert before == simulation.render(size=(320, 240))
    simulation.run_until(0.5)
    assert simulation.render(size=(320, 240)) != before
    assert size_of(simulation._repr_png_()) == (1280, 720)


def test_what_cannot_be_drawn_is_said():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 0.1
    result = scene.run()
    with pytest.raises(topple.InputError, match=r"^at: 5 is outside 0\.\.0\.1 s$"):
        result.render(at=5)
    with pytest.raises(topple.InputError, match="^at: nan is outside"):
        result.render(at=float("nan"))
    with pytest.raises(topple.InputError, match=r"^size: 10x10 is not WIDTHxHEIGHT with 64\.\.8192 each$"):
        result.render(size=(10, 10))
