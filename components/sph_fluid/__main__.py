"""Serve one fluid to a coupler: ``python -m quintet.components.sph_fluid``."""

from quintet.components.sph_fluid import MANIFEST
from quintet.interfaces.serving.process import main

if __name__ == "__main__":
    main(MANIFEST)
