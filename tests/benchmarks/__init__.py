"""Heavy comparisons that print what they measure; not collected as tests."""
