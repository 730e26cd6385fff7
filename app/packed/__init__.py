"""What a packer has to know: PyInstaller finds the hook in this folder by an entry point (`pyinstaller40`)."""

from pathlib import Path


def hook_folders() -> list[str]:
    """Return where hooks for PyInstaller are."""
    return [str(Path(__file__).parent)]
