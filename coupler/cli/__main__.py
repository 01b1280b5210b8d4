"""``python -m quintet.coupler.cli``: the command line without an installed script."""

from quintet.coupler.cli.commands import main

if __name__ == "__main__":
    main()
