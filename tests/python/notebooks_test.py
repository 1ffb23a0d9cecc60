import nbformat
import pytest
import topple
from nbconvert.preprocessors import CellExecutionError, ExecutePreprocessor


def executed(notebook):
    ExecutePreprocessor(timeout=250, kernel_name="python3").preprocess(notebook)
    return notebook


def of(notebook, kind):
    """What its cells showed, of one kind."""
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    if kind == "text":
        return "".join(output.text for output in shown if output.output_type == "stream" and output.name == "stdout")
    return [output.data[kind] for output in shown if kind in output.get("data", {})]


def read(source, name):
    notebook = nbformat.read(source / "assets/notebooks" / name, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells)
    return notebook


def test_the_engineers_notebook_has_a_curve_and_what_the_bracket_carries(source):
    notebook = executed(read(source, "fragility.ipynb"))
    text = of(notebook, "text")
    shares = {line.split()[0]: [int(word[:-1]) for word in line.split()[1:]]
              for line in text.splitlines() if line.split()[1:2] and line.split()[1].endswith("%")}
    assert shares["bracket"] == [0] * 10
    assert shares["free"][:3] == [0, 0, 0] and shares["free"][-1] > 80
    # West: nothing falls below g times depth over height, 1.53 m/s^2 of a bookcase whose books lie low
    median = float(text.split("overturn it at ")[1].split()[0])
    assert 2 < median < 5.5
    assert len([line for line in text.splitlines() if line.endswith(" N of 1500 N")]) == 12
    assert len(of(notebook, "image/png")) == 3


def test_the_teachers_notebook_answers_its_questions(source):
    notebook = executed(read(source, "lesson.ipynb"))
    text = of(notebook, "text")
    lines = [line.split(": ")[1] for line in text.splitlines() if "m/s²: " in line]
    assert lines == ["stays on the floor"] * 2 + ["lifts"] * 3  # below and above g b/h
    assert "tilt 0.0 degrees\ntilt 90.0 degrees" in text
    assert len(of(notebook, "image/png")) == 4


def test_a_result_shows_its_page_and_its_picture():
    cell = nbformat.v4.new_code_cell('import topple\ntopple.Scene("free-rocking").run()')
    notebook = executed(nbformat.v4.new_notebook(cells=[cell]))
    assert len(of(notebook, "image/png")) == 1
    page = topple.Scene("free-rocking").run()._repr_html_()  # none without emscripten
    assert [shown.split(" srcdoc=")[0] for shown in of(notebook, "text/html")] == ([page.split(" srcdoc=")[0]] if page else [])


def test_a_wrong_unit_is_told_in_the_notebook():
    cell = nbformat.v4.new_code_cell('import topple\ntopple.Scene("cabinet")["shake.1.amplitude"] = "150 mm"')
    with pytest.raises(CellExecutionError, match='"150 mm" is a length, expected an acceleration'):
        executed(nbformat.v4.new_notebook(cells=[cell]))
