"""Pure functions from joint motion to what the seat does, and back."""
