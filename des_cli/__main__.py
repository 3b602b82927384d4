"""The command ``des-coriolis``, and ``python -m des_cli``."""

from typing import NoReturn

from des_cli.cli.terminal import fill_streams
from des_cli.signals import die_at_once


def main() -> NoReturn:
    """Run the command line of this process."""
    die_at_once()
    fill_streams()
    # Imported here: Ctrl-C while click and its like are imported is no traceback.
    from des_cli.cli.main import main as run

    run()


if __name__ == "__main__":
    main()
