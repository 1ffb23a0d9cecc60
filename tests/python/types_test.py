import ast
import pathlib

import topple


def names_of_stub():
    stub = ast.parse(pathlib.Path(topple.__file__).with_name("__init__.pyi").read_text())
    names = {"": set()}
    for item in stub.body:
        if isinstance(item, ast.ClassDef):
            names[item.name] = {entry.name for entry in item.body if isinstance(entry, ast.FunctionDef)}
        elif isinstance(item, ast.FunctionDef):
            names[""].add(item.name)
    return names


def test_the_stub_has_the_names_of_the_module():
    assert pathlib.Path(topple.__file__).with_name("py.typed").exists()
    stub = names_of_stub()
    classes = {name: kind for name, kind in vars(topple).items() if isinstance(kind, type)}
    assert set(stub) - {""} == set(classes)
    assert stub[""] == {name for name, thing in vars(topple).items() if callable(thing) and name not in classes}
    own = {"__getitem__", "__setitem__", "_repr_png_", "_repr_html_"}
    for name, kind in classes.items():
        if not issubclass(kind, Exception):
            assert stub[name] - {"__init__"} == {entry for entry in vars(kind) if entry[0] != "_" or entry in own}, name


def test_everything_has_a_docstring_and_arrays_their_shape_and_unit():
    for kind in topple.Scene, topple.Result, topple.Simulation:
        assert kind.__doc__
        for name, thing in vars(kind).items():
            if name[0] != "_" and name not in ("title", "scene_name"):
                assert thing.__doc__, name
    assert topple.Result.position.__doc__.startswith("[row, node, 3] m")
    assert topple.Simulation.position.__doc__.startswith("[node, 3] m")
    assert topple.Result.load_factor.__doc__.startswith("[row] 1")


def test_the_solver_is_loaded_once():
    topple.Scene("free-rocking")
    assert len({line.split()[-1] for line in open("/proc/self/maps") if "libtopple_solver" in line}) == 1
