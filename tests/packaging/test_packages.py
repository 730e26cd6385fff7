"""The package list is written by hand, so it is compared with the folders."""

import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.packaging

ROOT = Path(__file__).parents[2]
FLOORS = ("app", "components", "engine", "scenes", "systems", "testing")
SHIPPED = {".vert", ".frag", ".geom", ".comp", ".glsl", ".yaml", ".png", ".npy", ".r16", ".txt", ".tmpl"}


def setuptools() -> dict[str, Any]:
    with (ROOT / "pyproject.toml").open("rb") as file:
        tables: dict[str, Any] = tomllib.load(file)["tool"]["setuptools"]
    return tables


def package_of(folder: Path) -> str:
    return ".".join(("tallgrass", *folder.relative_to(ROOT).parts))


def folders() -> list[Path]:
    inside = [folder for floor in FLOORS for folder in (ROOT / floor).rglob("*") if folder.is_dir()]
    return [ROOT, *(ROOT / floor for floor in FLOORS), *(each for each in inside if each.name != "__pycache__")]


def test_every_folder_with_python_in_it_is_a_listed_package() -> None:
    on_disk = {package_of(folder) for folder in folders() if any(folder.glob("*.py"))}
    assert sorted(on_disk) == sorted(setuptools()["packages"])


def test_every_listed_package_says_what_it_is_for() -> None:
    for package in setuptools()["packages"]:
        init = ROOT.joinpath(*package.split(".")[1:]) / "__init__.py"
        assert init.read_text("utf-8").startswith('"""'), f"{init} has no docstring"


def test_every_shader_scene_and_image_is_shipped_with_its_package() -> None:
    patterns = setuptools()["package-data"]
    forgotten = [
        file.relative_to(ROOT)
        for folder in folders()[1:]
        for file in folder.iterdir()
        if file.suffix in SHIPPED
        if not any(fnmatch(file.name, pattern) for pattern in patterns.get(package_of(folder), []))
    ]
    assert forgotten == []


def test_every_pattern_of_shipped_files_is_of_a_listed_package() -> None:
    assert set(setuptools()["package-data"]) <= set(setuptools()["packages"])


def test_no_test_folder_is_a_package() -> None:
    assert list((ROOT / "tests").rglob("__init__.py")) == []


def test_every_row_code_in_the_name_of_a_test_is_told() -> None:
    told = set(re.findall(r"^\| ([A-Z]\d+) \|", (ROOT / "tests" / "README.md").read_text("utf-8"), re.MULTILINE))
    names = [
        name
        for file in (ROOT / "tests").rglob("test_*.py")
        for name in re.findall(r"^def test_([a-z]\d+)_", file.read_text("utf-8"), re.MULTILINE)
    ]
    assert {name.upper() for name in names} == told
