"""Let ``python -m des_cli`` be the command ``des-coriolis``."""

from des_cli.cli.main import main

if __name__ == "__main__":
    main()
