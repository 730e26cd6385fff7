"""The page of examples: what each is; in the manual, its source too."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]


def example_pages() -> str:
    """Return a list of the examples, and what each is, with links to its files, as Markdown."""
    rows, parts = ["| program | shows |", "|---|---|"], []
    for name, files in examples().items():
        told = ast.get_docstring(ast.parse(next(file for file in files if _is_module(file)).read_text("utf-8"))) or ""
        first = " ".join(told.partition("\n\n")[0].split())
        rows.append(f"| [{name}](#{name}) | {first} |")
        parts += [f"## {name}", told]
        parts += [f"[`{file.relative_to(ROOT)}`](../{file.relative_to(ROOT)})" for file in files]
    return "\n\n".join(["\n".join(rows), *parts]) + "\n"


def with_sources(page: str, /) -> str:
    """Return the page with each file's source below its link, as the manual has it."""
    for file in (file for files in examples().values() for file in files):
        link = f"[`{file.relative_to(ROOT)}`](../{file.relative_to(ROOT)})"
        page = page.replace(link, f"`{file.relative_to(ROOT)}`:\n\n{fenced(file)}")
    return page


def examples() -> dict[str, list[Path]]:
    """Return the files of each example by its name: a program, or the folder of a package."""
    folder = ROOT / "examples"
    found = {file.stem: [file] for file in sorted(folder.glob("*.py"))}
    found |= {inner.name: sorted(_sources(inner)) for inner in sorted(folder.iterdir()) if any(inner.rglob("*.py"))}
    return found


def _sources(folder: Path) -> Iterator[Path]:
    for file in folder.rglob("*"):
        if file.suffix in {".py", ".toml", ".yaml", ".glsl"} and not any(part.startswith(".") for part in file.parts):
            yield file


def _is_module(file: Path) -> bool:
    return file.suffix == ".py" and file.parent.name != "tests"


def fenced(file: Path, /) -> str:
    """Return a file as a block of code."""
    return f"```{file.suffix[1:].replace('py', 'python')}\n{file.read_text('utf-8').rstrip()}\n```"
