"""Furniture that tips over when the floor shakes. Docstrings of the module say what is what."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, SupportsFloat, Union

import numpy as np
from numpy.typing import NDArray

_Value = Union[str, SupportsFloat, "list[Any]", "tuple[Any, ...]", NDArray[Any]]

__version__: str

class InputError(ValueError): ...
class RunError(RuntimeError): ...

class Scene:
    def __init__(self, source: str | PathLike[str]) -> None: ...
    @staticmethod
    def parse(text: str, origin: str = "scene.toml") -> Scene: ...
    def __setitem__(self, key: str, value: _Value) -> None: ...
    def __getitem__(self, key: str) -> float: ...
    def run(self, record: str | PathLike[str] | None = None) -> Result: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def bodies(self) -> list[str]: ...
    @property
    def members(self) -> list[tuple[str, str]]: ...
    @property
    def nodes(self) -> list[tuple[str, int]]: ...
    @property
    def elements(self) -> list[tuple[str, str, int]]: ...
    @property
    def contacts(self) -> list[tuple[str, int, str]]: ...
    @property
    def anchors(self) -> list[str]: ...

class Result:
    @property
    def time(self) -> NDArray[np.float64]: ...  # [row] s
    @property
    def step(self) -> NDArray[np.int64]: ...  # [row] 1
    @property
    def energy(self) -> dict[str, NDArray[np.float64]]: ...  # [row] J
    @property
    def position(self) -> NDArray[np.float32]: ...  # [row, node, 3] m
    @property
    def rotation(self) -> NDArray[np.float32]: ...  # [row, node, 4] 1
    @property
    def section_force(self) -> NDArray[np.float32]: ...  # [row, element, 6] N and N m
    @property
    def integration_point(self) -> NDArray[np.float32]: ...  # [row, element] 1
    @property
    def hinge(self) -> NDArray[np.uint8]: ...  # [row, element] 1
    @property
    def contact_depth(self) -> NDArray[np.float32]: ...  # [row, contact] 1
    @property
    def contact_force(self) -> NDArray[np.float32]: ...  # [row, contact, 3] N
    @property
    def member_contact(self) -> NDArray[np.float32]: ...  # [row, element, 4] N and 1
    @property
    def panel_contact(self) -> NDArray[np.float32]: ...  # [row, panel, 5] N and 1
    @property
    def centre(self) -> NDArray[np.float64]: ...  # [row, body, 3] m
    @property
    def body_rotation(self) -> NDArray[np.float64]: ...  # [row, body, 4] 1
    @property
    def tilt(self) -> NDArray[np.float64]: ...  # [row, body] rad
    @property
    def slide(self) -> NDArray[np.float64]: ...  # [row, body] m
    @property
    def body_energy(self) -> NDArray[np.float64]: ...  # [row, body] J
    @property
    def critical_angle(self) -> NDArray[np.float64]: ...  # [row, body] rad
    @property
    def model(self) -> NDArray[np.uint8]: ...  # [row, body] 1
    @property
    def floor_acceleration(self) -> NDArray[np.float64]: ...  # [row, 3] m/s^2
    @property
    def floor_displacement(self) -> NDArray[np.float64]: ...  # [row, 3] m
    @property
    def load_factor(self) -> NDArray[np.float64]: ...  # [row] 1
    @property
    def anchor_tension(self) -> NDArray[np.float32]: ...  # [row, anchor] N
    @property
    def anchor_energy(self) -> NDArray[np.float32]: ...  # [row, anchor] J
    @property
    def anchor_length(self) -> NDArray[np.float32]: ...  # [row, anchor] m
    @property
    def anchor_state(self) -> NDArray[np.float32]: ...  # [row, anchor] 1
    @property
    def summary(self) -> dict[str, Any]: ...
    @property
    def scene_name(self) -> str: ...
    @property
    def scene_text(self) -> str: ...
    @property
    def states(self) -> list[tuple[int, float, int]]: ...
    def render(self, at: float | None = None, size: tuple[int, int] = (1280, 720)) -> bytes: ...
    def _repr_png_(self) -> bytes: ...
    def _repr_html_(self) -> str | None: ...
    @property
    def bodies(self) -> list[str]: ...
    @property
    def members(self) -> list[tuple[str, str]]: ...
    @property
    def nodes(self) -> list[tuple[str, int]]: ...
    @property
    def elements(self) -> list[tuple[str, str, int]]: ...
    @property
    def contacts(self) -> list[tuple[str, int, str]]: ...
    @property
    def anchors(self) -> list[str]: ...

class Simulation:
    def __init__(self, scene: Scene) -> None: ...
    def step(self) -> None: ...
    def run_until(self, time: float) -> None: ...
    def edit(self, key: str, value: _Value) -> None: ...
    def fork(self) -> Simulation: ...
    @property
    def time(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def over(self) -> bool: ...
    @property
    def state_hash(self) -> int: ...
    @property
    def energy(self) -> dict[str, NDArray[np.float64]]: ...  # [] J
    @property
    def position(self) -> NDArray[np.float32]: ...  # [node, 3] m
    @property
    def rotation(self) -> NDArray[np.float32]: ...  # [node, 4] 1
    @property
    def section_force(self) -> NDArray[np.float32]: ...  # [element, 6] N and N m
    @property
    def integration_point(self) -> NDArray[np.float32]: ...  # [element] 1
    @property
    def hinge(self) -> NDArray[np.uint8]: ...  # [element] 1
    @property
    def contact_depth(self) -> NDArray[np.float32]: ...  # [contact] 1
    @property
    def contact_force(self) -> NDArray[np.float32]: ...  # [contact, 3] N
    @property
    def member_contact(self) -> NDArray[np.float32]: ...  # [element, 4] N and 1
    @property
    def panel_contact(self) -> NDArray[np.float32]: ...  # [panel, 5] N and 1
    @property
    def centre(self) -> NDArray[np.float64]: ...  # [body, 3] m
    @property
    def body_rotation(self) -> NDArray[np.float64]: ...  # [body, 4] 1
    @property
    def tilt(self) -> NDArray[np.float64]: ...  # [body] rad
    @property
    def slide(self) -> NDArray[np.float64]: ...  # [body] m
    @property
    def body_energy(self) -> NDArray[np.float64]: ...  # [body] J
    @property
    def critical_angle(self) -> NDArray[np.float64]: ...  # [body] rad
    @property
    def model(self) -> NDArray[np.uint8]: ...  # [body] 1
    @property
    def floor_acceleration(self) -> NDArray[np.float64]: ...  # [3] m/s^2
    @property
    def floor_displacement(self) -> NDArray[np.float64]: ...  # [3] m
    @property
    def load_factor(self) -> NDArray[np.float64]: ...  # [] 1
    @property
    def anchor_tension(self) -> NDArray[np.float32]: ...  # [anchor] N
    @property
    def anchor_energy(self) -> NDArray[np.float32]: ...  # [anchor] J
    @property
    def anchor_length(self) -> NDArray[np.float32]: ...  # [anchor] m
    @property
    def anchor_state(self) -> NDArray[np.float32]: ...  # [anchor] 1
    def render(self, size: tuple[int, int] = (1280, 720)) -> bytes: ...
    def _repr_png_(self) -> bytes: ...
    @property
    def bodies(self) -> list[str]: ...
    @property
    def members(self) -> list[tuple[str, str]]: ...
    @property
    def nodes(self) -> list[tuple[str, int]]: ...
    @property
    def elements(self) -> list[tuple[str, str, int]]: ...
    @property
    def contacts(self) -> list[tuple[str, int, str]]: ...
    @property
    def anchors(self) -> list[str]: ...

def open(path: str | PathLike[str]) -> Result: ...
def sweep(
    scene: Scene, cases: Sequence[Mapping[str, _Value]], jobs: int | None = None
) -> list[dict[str, Any]]: ...
