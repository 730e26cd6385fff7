"""The hook for PyInstaller, which finds this folder by the entry point `pyinstaller40`."""

from pathlib import Path


def hook_folders() -> list[str]:
    """Return the folders of hooks for PyInstaller."""
    return [str(Path(__file__).parent)]
