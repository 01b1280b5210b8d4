"""The process of this component."""

from quintet.components.dem_bodies import MANIFEST
from quintet.interfaces.process import main

if __name__ == "__main__":
    main(MANIFEST)
