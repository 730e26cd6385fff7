"""`./dev docs`: writes what is generated of the manual's pages, gathers them, makes its pictures, and builds it."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

from .examples import with_sources
from .pages import write
from .pictures import ROOT, make_pictures

DOCS = ROOT / "docs"
SOURCE = ROOT / "out" / "manual-source"
OUTSIDE = re.compile(r"\[(?P<text>[^\]]+)\]\(\.\./(?P<target>[^)#]+)\)")


def main() -> None:
    """Build the manual into out/manual."""
    write()
    kept = ROOT / "out" / "manual-pictures"
    make_pictures(kept)
    gather(SOURCE, kept)
    build(DOCS / "mkdocs.yml")
    print(f"{ROOT / 'out' / 'manual' / 'index.html'}")


def gather(source: Path, pictures: Path, /) -> None:
    """Gather the manual's pages in a folder, as they are in the repository but for their links, with its pictures."""
    shutil.rmtree(source, ignore_errors=True)
    shutil.copytree(DOCS, source, ignore=shutil.ignore_patterns("making", "mkdocs.yml", "__pycache__"))
    examples = source / "examples.md"
    examples.write_text(with_sources(examples.read_text("utf-8")), "utf-8")
    for page in source.glob("*.md"):
        page.write_text(OUTSIDE.sub(_inside, page.read_text("utf-8")), "utf-8")
    others = shutil.ignore_patterns("*.yaml", "*.json", "*.html", "*.py", "*.wav", ".made-from")
    shutil.copytree(pictures, source / "pictures", ignore=others)
    (source / "manual.css").write_text(style(), "utf-8")


def build(config: Path, /) -> None:
    """Build the manual as a configuration of mkdocs says."""
    mkdocs: list[str | Path] = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--clean", "-f", config]
    subprocess.run(mkdocs, check=True)


def _inside(link: re.Match[str]) -> str:
    """Return a link to a file of the checkout as the manual has it: an example has a page, others are only named."""
    parts = Path(link["target"]).parts
    return f"[{link['text']}](examples.md#{Path(parts[1]).stem})" if parts[0] == "examples" else link["text"]


def style() -> str:
    """Return the style of code and tables, light and dark."""
    from pygments.formatters import HtmlFormatter

    light = HtmlFormatter(style="default").get_style_defs(".codehilite")
    dark = HtmlFormatter(style="github-dark").get_style_defs("[data-bs-theme=dark] .codehilite")
    own = """
.codehilite { background: none !important; }
.codehilite pre { padding: 0.8rem; border: 1px solid var(--bs-border-color); border-radius: 0.4rem; }
table { font-size: 0.92rem; margin-bottom: 1.2rem; display: block; overflow-x: auto; }
td, th { padding: 0.25rem 0.6rem 0.25rem 0; vertical-align: top; border-bottom: 1px solid var(--bs-border-color); }
img { max-width: 100%; height: auto; }
"""
    return f"{light}\n{dark}\n{own}"


if __name__ == "__main__":
    main()
