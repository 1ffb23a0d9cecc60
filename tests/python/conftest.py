"""The program, to be held against the module."""

import json
import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).parents[2]


class Program:
    def __call__(self, *arguments):
        return subprocess.run([os.environ["TOPPLE_PROGRAM"], *map(str, arguments)], capture_output=True, text=True)

    def run(self, *arguments):
        ended = self("run", *arguments, "--quiet", "--json", "-")
        assert ended.returncode == 0, ended.stderr
        return json.loads(ended.stdout)

    def error(self, *arguments):
        """The line that a call ends with."""
        ended = self(*arguments)
        assert ended.returncode == 2, ended.stderr
        return ended.stderr.strip().removeprefix("topple: ")


@pytest.fixture(scope="session")
def program():
    return Program()


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def recording(program, tmp_path_factory):
    """paper-a, as the program records it."""
    file = tmp_path_factory.mktemp("recorded") / "paper-a.h5"
    program.run("paper-a", "-o", file)
    return file
