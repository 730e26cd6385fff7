"""`./dev release X.Y.Z [--dry-run]`: checks everything, moves the changelog's section, sets the version, and builds.

With `--dry-run` the checkout stays as it is. Commit, tag and upload are the owner's.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from datetime import UTC, date, datetime
from pathlib import Path
from tempfile import TemporaryDirectory

from packaging.version import InvalidVersion, Version

from .pages import write
from .public import broken, public, record, recorded

ROOT = Path(__file__).parents[2]
DIST = ROOT / "dist"
CHANGELOG, INIT = "CHANGELOG.md", "__init__.py"
UNRELEASED = "## [Unreleased]\n"
LARGEST = 1_300_000
"""Greatest size of the wheel [bytes]: modules and shaders take 1.2 MB, and more would be there by mistake."""


class ReleaseError(Exception):
    """Why there is no release."""


def main(words: Sequence[str]) -> int:
    """Make a release, or say why there is none; return the exit status."""
    versions = [word for word in words if word != "--dry-run"]
    if len(versions) != 1:
        sys.stderr.write("./dev release X.Y.Z [--dry-run]\n")
        return 2
    try:
        release(versions[0], dry_run="--dry-run" in words)
    except (ReleaseError, subprocess.CalledProcessError) as error:
        sys.stderr.write(f"release: {error}\n")
        return 1
    return 0


def release(version: str, *, dry_run: bool, checks: "Sequence[Callable[[], None]] | None" = None) -> None:
    """Check everything, build the files of a version, and write the version into the checkout unless `dry_run`."""
    changes = changed(
        version, datetime.now(UTC).date(), {name: (ROOT / name).read_text() for name in (CHANGELOG, INIT)}
    )
    for check in CHECKS if checks is None else checks:
        check()
    with TemporaryDirectory() as folder:
        built = build(Path(folder) / "tallgrass", changes)
        if not dry_run:
            DIST.mkdir(exist_ok=True)
            for file in built:
                shutil.copy(file, DIST)
            for name, text in changes.items():
                (ROOT / name).write_text(text, "utf-8")
            record()
            write()
    names = ", ".join(file.name for file in built)
    done = f"{names} can be built; nothing has changed" if dry_run else f"dist has {names}"
    print(f"{done}. {'' if dry_run else f'Next: git commit, git tag v{version}, twine upload.'}".rstrip())


def changed(version: str, day: date, texts: dict[str, str], /) -> dict[str, str]:
    """Return the files that name the version, as they are for a new one. Raises ReleaseError where it cannot be one."""
    (now,) = re.findall(r'^__version__ = "(.+)"$', texts[INIT], re.MULTILINE)
    try:
        wanted = Version(version)
    except InvalidVersion:
        raise ReleaseError(f"'{version}' is no version") from None
    if not re.fullmatch(r"\d+\.\d+\.\d+", version) or wanted < Version(now):
        raise ReleaseError(f"'{version}' is not X.Y.Z, or is older than {now}")
    before, mark, after = texts[CHANGELOG].partition(UNRELEASED)
    section = after.partition("\n## [")[0].strip()
    if not mark or not section:
        raise ReleaseError(f"{CHANGELOG} has nothing under [Unreleased]")
    if f"## [{version}]" in after:
        raise ReleaseError(f"{CHANGELOG} has {version} already")
    return {
        CHANGELOG: f"{before}{UNRELEASED}\n## [{version}] - {day:%Y-%m-%d}\n{after}",
        INIT: texts[INIT].replace(f'__version__ = "{now}"', f'__version__ = "{version}"'),
    }


def build(copy: Path, changes: dict[str, str], /) -> list[Path]:
    """Build the distributions from a copy of what is committed, with changed files, and look at them."""
    for name in _ran("git", "ls-files").splitlines():
        if (ROOT / name).is_file():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, copy / name)
    for name, text in changes.items():
        (copy / name).write_text(text, "utf-8")
    out = copy.parent / "dist"
    _ran(sys.executable, "-m", "build", "--no-isolation", "--outdir", out, copy)
    built = sorted(out.iterdir())
    _ran(sys.executable, "-m", "twine", "check", "--strict", *built)
    for wheel in out.glob("*.whl"):
        if wheel.stat().st_size > LARGEST:
            raise ReleaseError(f"{wheel.name} has {wheel.stat().st_size} bytes, and may have {LARGEST}")
    return built


def must_be_clean() -> None:
    """Raise ReleaseError where something is not committed."""
    if changes := _ran("git", "status", "--porcelain"):
        raise ReleaseError(f"commit first:\n{changes.rstrip()}")


def must_keep_its_word() -> None:
    """Raise ReleaseError where something public is gone, or a page is stale."""
    if told := broken(recorded(), public()):
        raise ReleaseError("\n".join(["what was public has changed:", *told]))
    if stale := write(check=True):
        raise ReleaseError(f"to be written again by python -m docs.making.pages: {', '.join(stale)}")


def must_pass() -> None:
    """Run style, types and all tests, those that take long as well; raises CalledProcessError where one fails."""
    for task in (["lint"], ["types"], ["test"], ["test", "-m", "slow"]):
        subprocess.run([ROOT / "dev", *task], cwd=ROOT, check=True)


def _ran(*command: str | Path) -> str:
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ReleaseError(f"{' '.join(map(str, command[:4]))}: {(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


CHECKS = (must_be_clean, must_keep_its_word, must_pass)
"""Checks before anything is built."""

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
