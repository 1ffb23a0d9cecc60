import re

import numpy as np
import pytest

import topple


def test_the_example_of_the_guide_does_what_it_says(source, tmp_path, monkeypatch):
    page = (source / "assets/guide/python.md").read_text()
    example = re.search(r"```python\n(.*?)```", page, re.DOTALL)[1]
    assert len(example.splitlines()) == 10
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(example, names)
    stays, falls = names["peaks"].values()
    assert stays < np.radians(20) < falls
    assert (tmp_path / "tipping.png").read_bytes().startswith(b"\x89PNG")


def test_the_guide_names_all_arrays(source):
    page = (source / "assets/guide/python.md").read_text()
    for name, kind in vars(topple.Result).items():
        if isinstance(kind, property):
            assert f"`{name}`" in page, name


def test_the_error_of_the_guide_is_that_of_the_module(source):
    line = re.search(r"```text\n(.*)\n```", (source / "assets/guide/python.md").read_text())[1]
    with pytest.raises(topple.InputError, match=f"^{re.escape(line)}$"):
        topple.Scene("cabinet")["shake.1.amplitude"] = "150 mm"
