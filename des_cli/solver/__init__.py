"""Methods that know no centrifuge: programs that are banded in time, and how they are solved."""
