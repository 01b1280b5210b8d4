"""``python -m quintet.components.stand_ins KIND ...`` runs one of them as a process."""

from quintet.interfaces.serving.process import main

main()
