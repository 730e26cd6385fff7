"""Entry point of the command `tallgrass`, without imports: games may lack the packages that commands need."""

import sys


def main() -> None:
    """Run the command line; without `tallgrass[commands]`, say what to install and exit with 1."""
    try:
        from .cli import main as run
    except ModuleNotFoundError as error:
        if error.name != "typer":  # which brings rich
            raise
        sys.exit("commands are made with typer and rich: pip install 'tallgrass[commands]'")
    run()
