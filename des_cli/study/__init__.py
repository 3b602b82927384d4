"""The study as a room: its equations, its law, and every quantity that it names."""
