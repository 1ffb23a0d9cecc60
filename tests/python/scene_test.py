import numpy as np
import pytest

import topple


def test_a_file_and_a_built_in_scene_are_the_same(source):
    file = topple.Scene(source / "assets/scenes/cabinet.toml")
    assert (file.name, file.text) == ("cabinet", topple.Scene("cabinet").text)
    assert topple.Scene.parse(file.text).text == file.text


@pytest.mark.parametrize(
    "key, value, written",
    [
        ("shake.1.amplitude", "150 gal", "150 gal"),
        ("shake.1.amplitude", 1.5, "1.5"),
        ("shake.1.amplitude", np.float64(0.1), "0.1"),
        ("shake.1.direction", np.array([1.0, 0, 0]), "[1.0, 0.0, 0.0]"),
        ("run.want", ["motion", "stress"], '["motion", "stress"]'),
        ("run.settle", False, "false"),
        ("run.integrator", "newmark", "newmark"),
        ("run.duration", 2, "2"),
    ],
)
def test_a_key_is_set_as_by_the_program(program, tmp_path, key, value, written):
    scene = topple.Scene("free-rocking" if key.startswith("run") else "paper-a")
    scene[key] = value
    file = tmp_path / "one.h5"
    ended = program("run", scene.name, "--set", f"{key}={written}", "--set", "run.duration=0.01", "-o", file)
    assert ended.returncode == 0, ended.stderr
    scene["run.duration"] = "0.01"
    assert scene.text == topple.open(file).scene_text


def test_a_number_is_read_in_si():
    scene = topple.Scene("paper-a")
    scene["shake.1.amplitude"] = "150 gal"
    assert scene["shake.1.amplitude"] == 1.5
    assert topple.Scene("paper-a")["contact.friction"] == 0.6  # the default


@pytest.mark.parametrize(
    "key, value", [("shake.1.amplitude", "150 mm"), ("shake.1.amplitud", "1"), ("shake.7.amplitude", "1"),
                   ("contact.friction", "2.4"), ("run.integrator", "euler")]
)
def test_a_wrong_value_says_what_the_program_says_and_changes_nothing(program, key, value):
    scene = topple.Scene("paper-a")
    before = scene.text
    with pytest.raises(topple.InputError) as raised:
        scene[key] = value
    assert str(raised.value) == program.error("run", "paper-a", "--set", f"{key}={value}")
    assert key.rsplit(".", 1)[1][:5] in str(raised.value) and "\n" not in str(raised.value)
    assert scene.text == before
    scene["run.duration"] = 1  # it can still be changed


def test_a_wrong_file_says_line_and_column(program, tmp_path):
    file = tmp_path / "wrong.toml"
    file.write_text('topple = 1\nfloor = {}\nshake = [{ type = "sine", frequency = "0.5 Hz", amplitude = "2 mm" }]\n')
    with pytest.raises(topple.InputError, match=r"wrong\.toml:3:\d+: shake\.1\.amplitude: ") as raised:
        topple.Scene(file)
    assert str(raised.value) == program.error("run", file)
    with pytest.raises(ValueError, match=r"^mine\.toml:3:"):
        topple.Scene.parse(file.read_text(), "mine.toml")


def test_a_misspelt_scene_is_named(program):
    with pytest.raises(topple.InputError) as raised:
        topple.Scene("paper-aa")
    assert str(raised.value) == program.error("run", "paper-aa")


def test_what_is_no_value_is_refused():
    scene = topple.Scene("paper-a")
    with pytest.raises(TypeError, match="a value is a text, a number"):
        scene["contact.friction"] = object()
    with pytest.raises(topple.InputError, match="title: is no key that takes one number"):
        scene["title"]


def test_names_are_those_of_the_axes():
    scene = topple.Scene("paper-a")
    result = scene.run()
    assert scene.bodies == result.bodies and len(scene.bodies) == result.tilt.shape[1]
    assert len(scene.nodes) == result.position.shape[1]
    assert len(scene.elements) == result.section_force.shape[1]
    assert len(scene.contacts) == result.contact_force.shape[1]
    assert scene.nodes[0] == (scene.bodies[0], 0)
    assert scene.elements[1] == (*scene.members[0], 1)
    anchored = topple.Scene("anchored")
    anchored["run.duration"] = 0.05
    assert len(anchored.anchors) == anchored.run().anchor_tension.shape[1] == 2
