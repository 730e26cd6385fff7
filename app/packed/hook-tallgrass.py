"""Files and modules that PyInstaller packs with tallgrass, also those of all installed winds and systems.

Scenes import winds and systems by name at run time, so a packer cannot find them in the code.
"""

from PyInstaller.utils.hooks import collect_data_files, collect_entry_point, copy_metadata

FILES = {
    "tallgrass.scenes": ["*.yaml", "*.png"],
    "tallgrass.engine": ["**/*.glsl", "**/*.vert", "**/*.frag"],
    "tallgrass.systems": ["**/*.glsl", "**/*.vert", "**/*.frag", "**/*.py"],
}
"""Files read at run time, by package. Code counts, too: its hash is a part of the keys of caches."""

datas = copy_metadata("tallgrass")
hiddenimports = []
for package, names in FILES.items():
    datas += collect_data_files(package, include_py_files=True, includes=names)
for group in ("tallgrass.wind", "tallgrass.systems"):
    found, modules = collect_entry_point(group)
    datas += found
    hiddenimports += modules
    for name in {module.partition(".")[0] for module in modules} - {"tallgrass"}:
        datas += collect_data_files(name)  # twins of plugins' winds, and all else that they read beside their modules
