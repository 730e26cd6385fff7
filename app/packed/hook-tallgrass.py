"""What PyInstaller packs with tallgrass: its files, and the winds and systems of all that is installed.

Winds and systems are imported by name when a scene asks for them, which no packer sees.
"""

from PyInstaller.utils.hooks import collect_data_files, collect_entry_point, copy_metadata

FILES = {
    "tallgrass.scenes": ["*.yaml", "*.png"],
    "tallgrass.engine": ["**/*.glsl", "**/*.vert", "**/*.frag"],
    "tallgrass.systems": [
        "**/*.glsl",
        "**/*.vert",
        "**/*.frag",
        "grow/*.py",
        "stock/*.py",
        "**/grow.py",
        "light/repeating.py",
    ],
}
"""What is read at run time, by package. So is the code that grows: what was grown by other code is grown again."""

datas = copy_metadata("tallgrass")
hiddenimports = []
for package, names in FILES.items():
    datas += collect_data_files(package, include_py_files=True, includes=names)
for group in ("tallgrass.wind", "tallgrass.systems"):
    found, modules = collect_entry_point(group)
    datas += found
    hiddenimports += modules
    for name in {module.partition(".")[0] for module in modules} - {"tallgrass"}:
        datas += collect_data_files(name, includes=["**/*.glsl"])  # the twins of others' winds
