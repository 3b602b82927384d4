"""The independent check of a solution; it shares nothing with the methods that find one."""
