"""Finding what draws the panel: it is needed only where a scene is edited."""

import importlib

from ..studio.errors import MachineError


def need_panel() -> None:
    """Load imgui-bundle; raises MachineError where it is not installed."""
    try:
        importlib.import_module("imgui_bundle")
    except ImportError:
        raise MachineError("the panel of --edit is drawn by imgui-bundle: pip install 'tallgrass[edit]'") from None
