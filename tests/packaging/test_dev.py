"""The one command of a fresh clone sets up once, mends what is broken, and names what it cannot install."""

import os
import shutil
import subprocess
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.packaging,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the machines imitated here are Debian's"),
]

ROOT = Path(__file__).parents[2]
TOOLS = ("cat", "dirname", "grep", "id", "ln", "mkdir", "mktemp", "rm", "tail", "uname", "sh")
LINE = "apt-get install -y --no-install-recommends"
UV = f"""#!/bin/sh
echo "$1" >>"$CALLS"
[ "$1" = venv ] || exit 0
for place; do :; done
"{sys.executable}" -m venv --without-pip "$place"
echo "{sysconfig.get_path("purelib")}" >"$(echo "$place"/lib/python*/site-packages)/all.pth"
echo "#!$place/bin/python" >"$place/bin/pip"
"""


class Machine:
    """A clone on a pretended machine that has the named tools."""

    def __init__(self, folder: Path) -> None:
        self.clone = folder / "a clone"
        self.tools = folder / "bin"
        self.calls = folder / "calls"
        self.clone.mkdir()
        self.tools.mkdir()
        for name in ("dev", "pyproject.toml"):
            shutil.copy(ROOT / name, self.clone)
        for name in TOOLS:
            self.tools.joinpath(name).symlink_to(shutil.which(name) or "")
        self.has("Xvfb", "exit 0")
        self.has("id", "echo 1000")
        self.has("ldconfig", "echo 'libEGL.so.1 ' 'libGL.so.1 ' 'libfontconfig.so.1 ' 'libfreetype.so.6 '")

    def has(self, name: str, script: str, *, in_environment: bool = False) -> None:
        """Add a program that runs `script` to the machine, or to the environment on it."""
        program = (self.clone / ".venv" / "bin" if in_environment else self.tools) / name
        program.unlink(missing_ok=True)
        program.write_text(script if script.startswith("#!") else f"#!/bin/sh\n{script}\n", "utf-8")
        program.chmod(0o755)

    def dev(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run `./dev` from elsewhere."""
        place = {"PATH": str(self.tools), "HOME": str(self.clone), "CALLS": str(self.calls)}
        command: list[str | Path] = [shutil.which("sh") or "sh", self.clone / "dev", *arguments]
        return subprocess.run(command, cwd=self.tools, env=place, capture_output=True, text=True, check=False)

    def setup(self) -> list[str]:
        """Set up, and return the arguments of the installer's calls."""
        self.calls.write_text("", "utf-8")
        done = self.dev("setup")
        assert done.returncode == 0, done.stderr
        return self.calls.read_text("utf-8").split()


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


@pytest.fixture
def ready(machine: Machine) -> Machine:
    machine.has("uv", UV)
    assert machine.setup() == ["venv", "pip"]
    return machine


def test_help_sets_nothing_up(machine: Machine) -> None:
    done = machine.dev("--help")
    assert done.returncode == 0
    assert done.stdout.startswith("./dev [ARGS]")
    assert not (machine.clone / ".venv").exists()


def test_without_python_a_user_is_told_the_whole_line(machine: Machine) -> None:
    machine.has("apt-get", "exit 100")
    machine.has("ldconfig", "echo 'libGL.so.1 '")
    machine.tools.joinpath("Xvfb").unlink()
    done = machine.dev("test")
    assert done.returncode == 3
    assert done.stderr == (
        f"dev: first: sudo apt-get update && sudo {LINE} "
        "python3 python3-venv libegl1 libfontconfig1 libfreetype6 xvfb xauth\n"
    )


def test_root_gets_the_packages_installed(machine: Machine) -> None:
    machine.has("id", "echo 0")
    machine.has("ldconfig", "echo 'libGL.so.1 '")
    machine.has("apt-get", 'echo "$*" >>"$CALLS"')
    machine.has("uv", UV)
    done = machine.dev("setup")
    assert done.returncode == 0, done.stderr
    update, install = machine.calls.read_text("utf-8").splitlines()[:2]
    assert update == "update"
    assert f"apt-get {install}" == f"{LINE} libegl1 libfontconfig1 libfreetype6"


def test_walking_needs_gl_but_testing_goes_on_without(ready: Machine) -> None:
    ready.has("apt-get", "exit 100")
    ready.has("ldconfig", "echo 'libGL.so.1 ' 'libfontconfig.so.1 ' 'libfreetype.so.6 '")
    ready.has("pytest", "exit 0", in_environment=True)
    assert ready.dev().returncode == 3
    done = ready.dev("test", "--version")
    assert done.returncode == 0
    assert f"some tests will be skipped; to run them all: sudo apt-get update && sudo {LINE} libegl1" in done.stderr


def test_a_second_setup_does_nothing(ready: Machine) -> None:
    assert ready.setup() == []


def test_a_changed_project_is_installed_again_in_the_same_environment(ready: Machine) -> None:
    with ready.clone.joinpath("pyproject.toml").open("a") as file:
        file.write("# changed\n")
    assert ready.setup() == ["pip"]
    assert ready.setup() == []


def test_a_half_made_environment_is_made_anew(ready: Machine) -> None:
    ready.clone.joinpath(".venv", ".made").unlink()
    assert ready.setup() == ["venv", "pip"]


def test_an_environment_without_its_packages_is_made_anew(ready: Machine) -> None:
    (listed,) = ready.clone.glob(".venv/lib/python*/site-packages/all.pth")
    listed.unlink()
    assert ready.setup() == ["venv", "pip"]


def test_a_moved_clone_gets_an_environment_of_its_own(ready: Machine) -> None:
    ready.clone = ready.clone.rename(ready.clone.with_name("elsewhere"))
    assert ready.setup() == ["venv", "pip"]


def test_an_environment_whose_python_is_gone_is_made_anew(ready: Machine) -> None:
    ready.clone.joinpath(".venv", "bin", "python").unlink()
    ready.clone.joinpath(".venv", "bin", "python").symlink_to("/nowhere/python3")
    assert ready.setup() == ["venv", "pip"]


def test_without_a_display_a_film_and_a_picture_are_drawn_with_the_same_arguments(ready: Machine) -> None:
    ready.has("tallgrass", 'echo "$*" >>"$CALLS"', in_environment=True)
    ready.calls.write_text("", "utf-8")
    done = ready.dev("hills", "--preset", "low")
    assert done.returncode == 0
    assert len(done.stderr.splitlines()) == 1
    film, shot = ready.calls.read_text("utf-8").splitlines()
    assert film.startswith("film ")
    assert film.endswith(f"hills --preset low -o {ready.clone}/out/walk.webp")
    assert shot.startswith("shot ")
    assert shot.endswith(f"hills --preset low -o {ready.clone}/out/walk.png")


def test_the_manual_is_built_and_what_builds_it_installed_where_it_is_missing(ready: Machine) -> None:
    build = ready.clone / "docs" / "making" / "build.py"
    build.parent.mkdir(parents=True)
    build.write_text("print('built')", "utf-8")
    ready.calls.write_text("", "utf-8")
    done = ready.dev("docs")
    assert (done.returncode, done.stdout) == (0, "built\n"), done.stderr
    assert "the manual is not tried in a browser; to do that: install what Debian calls chromium" in done.stderr
    missing = find_spec("mkdocs") is None
    assert (ready.calls.read_text("utf-8").split() == ["pip"]) == missing


def test_the_manual_is_tried_where_there_is_a_browser(ready: Machine) -> None:
    build = ready.clone / "docs" / "making" / "build.py"
    build.parent.mkdir(parents=True)
    build.write_text("print('built')", "utf-8")
    ready.has("chromium", "exit 0")
    ready.has("pytest", 'echo "tried by $*"', in_environment=True)
    done = ready.dev("docs")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0] == "built"
    assert done.stdout.splitlines()[1].endswith("tests/docs/test_site.py")


def test_the_script_keeps_to_the_posix_shell() -> None:
    checker = shutil.which("shellcheck")
    command = [checker, "--shell=sh"] if checker else [shutil.which("dash") or "sh", "-n"]
    done = subprocess.run([*command, ROOT / "dev"], capture_output=True, text=True, check=False, env=dict(os.environ))
    assert done.returncode == 0, done.stdout + done.stderr
