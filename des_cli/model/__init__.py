"""What things are: frozen dataclasses over read-only arrays, without I/O."""
