"""Where the command `tallgrass` begins: a game that only draws has not installed what commands are made with."""

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
