"""The process of this component."""

from quintet.components.mooring_lines import MANIFEST
from quintet.interfaces.serving.process import main

if __name__ == "__main__":
    main(MANIFEST)
