"""The process of this component."""

from quintet.components.fe_plate.heat import MANIFEST
from quintet.interfaces.serving.process import main

if __name__ == "__main__":
    main(MANIFEST)
