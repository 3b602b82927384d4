"""The last check before a command table gets its name: of the bytes that were written."""
