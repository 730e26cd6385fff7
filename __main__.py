"""The command `tallgrass`, run as `python -m tallgrass`."""

from .app.entry import main

if __name__ == "__main__":
    main()
